// memory.c -- device memory that the host gives: what is asked for, and that all of it comes back.
#include "rig.h"
#include "skip.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

// One large VkDeviceMemory, given out in pieces at odd places, as an allocator of a renderer would.
typedef struct pool {
    rig *r;
    VkDeviceMemory memory[8]; // by type
    char *mapped[8];
    VkDeviceSize size, used[8];
    uint32_t live, asked;
    VkDeviceSize bytes;
    enum { GIVES, REFUSES, GIVES_NOTHING, GIVES_ASKEW } mood;
} pool;

static uint32_t type_of(const tyn_memory_request *request)
{
    uint32_t type = 0;
    while (!(request->requirements.memoryTypeBits >> type & 1)) {
        type++;
    }
    assert_int_equal(request->requirements.memoryTypeBits, 1u << type);
    assert_true(type < 8);
    return type;
}

static VkResult pool_allocate(void *user, const tyn_memory_request *request, tyn_allocation *out)
{
    pool *p = user;
    host *h = &p->r->host;
    const uint32_t type = type_of(request);
    const VkDeviceSize align = request->requirements.alignment;
    assert_true(align && !(align & (align - 1)));
    p->asked++;
    if (p->mood == REFUSES) {
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    if (!p->memory[type]) {
        const bool visible =
            h->memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
        assert_int_equal(h->vk.AllocateMemory(h->device,
                                              &(VkMemoryAllocateInfo){
                                                  .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                                  .allocationSize = p->size,
                                                  .memoryTypeIndex = type,
                                              },
                                              NULL, &p->memory[type]),
                         VK_SUCCESS);
        if (visible) {
            assert_int_equal(h->vk.MapMemory(h->device, p->memory[type], 0, VK_WHOLE_SIZE, 0,
                                             (void **)&p->mapped[type]),
                             VK_SUCCESS);
        }
    }
    // Never at the beginning: offsets have to count.
    const VkDeviceSize at = (p->used[type] + align) / align * align;
    assert_true(at + request->requirements.size <= p->size);
    p->used[type] = at + request->requirements.size;
    *out = (tyn_allocation){.memory = p->mood == GIVES_NOTHING ? VK_NULL_HANDLE : p->memory[type],
                            .offset = p->mood == GIVES_ASKEW ? at + 1 : at,
                            .mapped = request->mapped ? p->mapped[type] + at : NULL,
                            .handle = p};
    p->live++;
    p->bytes += request->requirements.size;
    return VK_SUCCESS;
}

static void pool_free(void *user, const tyn_allocation *allocation)
{
    pool *p = user;
    assert_ptr_equal(allocation->handle, p);
    assert_true(p->live > 0);
    p->live--;
}

static void pool_close(pool *p)
{
    for (int t = 0; t < 8; t++) {
        p->r->host.vk.FreeMemory(p->r->host.device, p->memory[t], NULL);
    }
}

// The same picture as with memory of our own; every block comes back.
static void memory_of_the_host(void **state)
{
    (void)state;
    rig r;
    if (!rig_open(&r, true)) {
        skip_all("the host has no device");
    }
    tyn_device *own = NULL, *lent = NULL;
    tyn_context *ctx = NULL;
    assert_int_equal(rig_device(&r, false, NULL, &own), TYN_OK);
    assert_int_equal(rig_context(&r, own, "pop", &ctx), TYN_OK);
    rig_frame(&r, ctx);
    const size_t bytes = r.picture.size;
    void *expected = malloc(bytes);
    memcpy(expected, r.picture.data, bytes);
    assert_true(rig_light(&r) > 1);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&own);

    pool p = {.r = &r, .size = 1024u << 20};
    const tyn_allocator allocator = {pool_allocate, pool_free, &p};
    assert_int_equal(rig_device(&r, false, &allocator, &lent), TYN_OK);
    assert_int_equal(rig_context(&r, lent, "pop", &ctx), TYN_OK);
    rig_frame(&r, ctx);
    assert_memory_equal(expected, r.picture.data, bytes);
    print_message("asked for %u blocks, %.1f MiB\n", p.asked, (double)p.bytes / (1 << 20));
    assert_true(p.live > 0 && p.asked <= 8);
    rig_expect_silence(&r);

    // What it cannot give, or gives wrongly, is an error with a line; the context works again afterwards.
    static const struct {
        int mood;
        tyn_result result;
        const char *line;
    } moods[] = {{REFUSES, TYN_ERR_MEMORY, "out of device memory"},
                 {GIVES_NOTHING, TYN_ERR_DEVICE, NULL},
                 {GIVES_ASKEW, TYN_ERR_DEVICE, NULL}};
    for (size_t i = 0; i < sizeof moods / sizeof moods[0]; i++) {
        tyn_context_destroy(&ctx);
        assert_int_equal(p.live, 0);
        assert_int_equal(rig_context(&r, lent, "pop", &ctx), TYN_OK);
        r.quiet = true;
        p.mood = moods[i].mood;
        const uint32_t before = r.errors;
        assert_int_equal(rig_prepare(&r, ctx), moods[i].result);
        assert_true(r.errors > before);
        assert_true(!moods[i].line || strstr(r.last_error, moods[i].line));
        assert_int_equal(p.live, 0);
        r.quiet = false;
        r.errors = 0;
        p.mood = GIVES;
        rig_frame(&r, ctx);
        assert_memory_equal(expected, r.picture.data, bytes);
    }
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&lent);
    assert_int_equal(p.live, 0);

    // Half an allocator is none.
    r.quiet = true;
    const tyn_allocator half = {.allocate = pool_allocate};
    assert_int_equal(rig_device(&r, false, &half, &lent), TYN_ERR_PARAMS);
    assert_null(lent);
    assert_non_null(strstr(r.last_error, "allocator.free"));
    free(expected);
    pool_close(&p);
    rig_close(&r);
}

static tyn_result open_with(rig *r, tyn_device *dev, double mib, tyn_context **ctx)
{
    tyn_context_destroy(ctx);
    assert_int_equal(
        tyn_context_create(dev,
                           tyn_context_params(.method = "single", .settings = r->settings,
                                              .frames_in_flight = HOST_SLOTS,
                                              .memory_budget = (uint64_t)(mib * (1 << 20))),
                           ctx),
        TYN_OK);
    return rig_prepare(r, *ctx);
}

// What is needed is accepted, and 1 MiB less refused with a line; the context then draws as before.
static void budget(void **state)
{
    (void)state;
    rig r;
    if (!rig_open(&r, true)) {
        skip_all("the host has no device");
    }
    tyn_device *dev = NULL;
    tyn_context *ctx = NULL;
    assert_int_equal(rig_device(&r, false, NULL, &dev), TYN_OK);
    assert_int_equal(rig_context(&r, dev, "single", &ctx), TYN_OK);
    rig_frame(&r, ctx);
    const size_t bytes = r.picture.size;
    void *expected = malloc(bytes);
    memcpy(expected, r.picture.data, bytes);

    r.quiet = true;
    double needed = 0;
    assert_int_equal(open_with(&r, dev, 1e-4, &ctx), TYN_ERR_MEMORY);
    assert_int_equal(
        sscanf(r.last_error,
               "memory_budget is 0.00 MiB, and %lf MiB are needed; the largest: ", &needed),
        1);
    print_message("%s\n", r.last_error);
    assert_int_equal(open_with(&r, dev, needed - 1, &ctx), TYN_ERR_MEMORY);
    assert_int_equal(r.errors, 2);                                     // one line each
    assert_int_equal(open_with(&r, dev, needed + 0.01, &ctx), TYN_OK); // the line says hundredths
    rig_frame(&r, ctx);
    assert_memory_equal(expected, r.picture.data, bytes);

    // A larger picture is refused; with the former all is as it was.
    rig_resize(&r, 32 * RIG_WIDTH, 32 * RIG_HEIGHT);
    assert_int_equal(rig_prepare(&r, ctx), TYN_ERR_MEMORY);
    assert_int_equal(r.errors, 3);
    rig_resize(&r, RIG_WIDTH, RIG_HEIGHT);
    r.errors = 0;
    r.quiet = false;
    rig_frame(&r, ctx);
    assert_memory_equal(expected, r.picture.data, bytes);
    free(expected);
    tyn_context_destroy(&ctx);
    tyn_device_destroy(&dev);
    rig_expect_silence(&r);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(memory_of_the_host),
                                       cmocka_unit_test(budget)};
    return cmocka_run_group_tests_name("embed_memory", tests, NULL, NULL);
}
