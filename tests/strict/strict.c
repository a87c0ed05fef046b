// strict.c -- pictures on a device with least limits (strict_driver.c) are the software device's, and what exceeds them is refused.
//
// The validation layer is above that driver: a call beyond its limits, or a feature that it lacks, fails the case that makes it.
#include "gpu/memory.h"
#include "bound.h"
#include "gpu_test.h"
#include "offline_frame.h"
#include "picture.h"
#include "sample_scene.h"
#include "skip.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48 };

typedef struct devices {
    gpu_test t; // .dev: the device under test
    tyn_device *software;
} devices;

static void on_log(void *user, tyn_log_level level, const char *message)
{
    gpu_test *t = user;
    if (level == TYN_LOG_ERROR) {
        t->errors++;
        snprintf(t->last_error, sizeof t->last_error, "%s", message);
    }
    if (level == TYN_LOG_ERROR && !t->quiet) {
        fprintf(stderr, "%s\n", message);
    }
}

static int setup(void **state)
{
    devices *d = calloc(1, sizeof *d);
    d->t.log = (tyn_log){on_log, &d->t, TYN_LOG_WARN};
    const tyn_result strict = tyn_device_open(
        tyn_device_open_params(.select = "strict", .validation = true, .log = d->t.log), &d->t.dev);
    const tyn_result software = tyn_device_open(
        tyn_device_open_params(.select = "llvmpipe", .validation = true, .log = d->t.log),
        &d->software);
    if (strict != TYN_OK || software != TYN_OK) {
        if (getenv("CI")) {
            fprintf(stderr, "no software device with validation layers\n");
            exit(1);
        }
        skip_all("no software device with validation layers");
    }
    *state = d;
    return 0;
}

static int teardown(void **state)
{
    devices *d = *state;
    tyn_device_destroy(&d->t.dev);
    tyn_device_destroy(&d->software);
    free(d);
    if (!bounds_near(true)) { // cmocka does not count what a teardown gives back
        exit(EXIT_FAILURE);
    }
    return 0;
}

// ---- refusals -----------------------------------------------------------------------------------

static void refuses_features(void **state)
{
    const devices *d = *state;
    VkDevice made;
    const VkPhysicalDeviceFeatures wanted = {.shaderFloat64 = VK_TRUE};
    const VkResult result = d->t.dev->vk.CreateDevice(
        d->t.dev->physical_device,
        &(VkDeviceCreateInfo){
            .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
            .pEnabledFeatures = &wanted,
            .queueCreateInfoCount = 1,
            .pQueueCreateInfos =
                &(VkDeviceQueueCreateInfo){.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueCount = 1,
                                           .pQueuePriorities = (const float[]){1.0f}}},
        NULL, &made);
    assert_int_equal(result, VK_ERROR_FEATURE_NOT_PRESENT);
}

static void refuses_to_map_its_own_memory(void **state)
{
    devices *d = *state;
    const tyn_device *dev = d->t.dev;
    VkDeviceMemory memory;
    void *mapped;
    d->t.quiet = true;
    assert_int_equal(dev->vk.AllocateMemory(
                         dev->device,
                         &(VkMemoryAllocateInfo){.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                                 .allocationSize = 4096,
                                                 .memoryTypeIndex = (uint32_t)tyn_memory_type(
                                                     dev, ~0u, TYN_MEMORY_DEVICE)},
                         NULL, &memory),
                     VK_SUCCESS);
    assert_int_not_equal(dev->vk.MapMemory(dev->device, memory, 0, VK_WHOLE_SIZE, 0, &mapped),
                         VK_SUCCESS);
    dev->vk.FreeMemory(dev->device, memory, NULL);
    assert_non_null(strstr(d->t.last_error, "VUID-vkMapMemory-memory-00682"));
    d->t.quiet = false;
}

// Limits are checked by the validation layer, which is above the driver.
static void refuses_what_exceeds_limits(void **state)
{
    devices *d = *state;
    const tyn_device *dev = d->t.dev;
    d->t.quiet = true;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, 132};
    dev->vk.CreatePipelineLayout(
        dev->device,
        &(VkPipelineLayoutCreateInfo){.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                      .pushConstantRangeCount = 1,
                                      .pPushConstantRanges = &range},
        NULL, &layout);
    dev->vk.DestroyPipelineLayout(dev->device, layout, NULL);
    assert_non_null(strstr(d->t.last_error, "maxPushConstantsSize"));
    d->t.quiet = false;
}

// ---- pictures -----------------------------------------------------------------------------------

static const char fewer_cells[] = "the solve of the lattice is ended before it has converged, and "
                                  "this device's coarse levels are fewer";

static const char other_order[] =
    "where threads share a place's virtual lights, as on cards, these "
    "are added in another order: half an epsilon is 6e-8";

static const struct {
    const char *scene, *method, *settings;
    uint32_t samples;
    double bound;
    const char *why; // pictures are not the same bits
} cases[] = {
    {"cloud", "pop", NULL, 0, 1e-3, fewer_cells},
    {"room", "pop", NULL, 0, 1e-3, fewer_cells},
    {"cornell-smoke", "path", NULL, 4, 0, NULL},
    {"smoke-sky", "refined", NULL, 2, 0, NULL},
    {"smoke-sky", "lpv", NULL, 0, 0, NULL},
    {"cornell-smoke", "photon", "photon_trace.generations=4 photon_trace.cells=8", 0, 1e-7,
     other_order},
};

static void render(picture *p, devices *d, tyn_device *dev, size_t i)
{
    tyn_scene scene;
    sample_scene_load(&scene, cases[i].scene, &d->t);
    tyn_view view = {.width = SIZE, .height = SIZE};
    view.camera = scene.cameras[0];
    picture_render(p, dev, cases[i].method, &scene, &view, cases[i].settings, cases[i].samples);
    tyn_scene_finish(&scene);
}

// Sizes of dispatches, memory types and alignments leave the bits as they are.
static void pictures(void **state)
{
    devices *d = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        picture strict, software;
        render(&strict, d, d->t.dev, i);
        render(&software, d, d->software, i);
        const picture_error e = picture_compare(&strict, &software, 1);
        const bool same = within(e.rel_l1, cases[i].bound, cases[i].why, "%s by %s", cases[i].scene,
                                 cases[i].method);
        picture_free(&strict);
        picture_free(&software);
        assert_true(same);
    }
}

int main(void)
{
    const struct CMUnitTest cases_of_all[] = {
        cmocka_unit_test(pictures),
        cmocka_unit_test(refuses_features),
        cmocka_unit_test(refuses_to_map_its_own_memory),
        cmocka_unit_test(refuses_what_exceeds_limits),
    };
    return run_cases(cases_of_all, setup, teardown);
}
