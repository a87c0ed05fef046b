// needs.c -- the table of needs: complete for all kernels, and what a device without a row gets.
#include "gpu/needs.h"
#include "gpu/device.h"
#include <tyndall/registry.h>
#include <spirv/unified1/spirv.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

static const tyn_need *need(tyn_need_id id)
{
    uint32_t count;
    const tyn_need *needs = tyn_needs(&count);
    assert_int_equal(count, TYN_NUM_NEEDS);
    return &needs[id];
}

// ---- kernels ------------------------------------------------------------------------------------

// Capabilities beyond Vulkan 1.3's own are features of the table.
static void check_capabilities(const tyn_kernel *kernel, const uint32_t *spirv, size_t bytes)
{
    for (size_t i = 5; i < bytes / sizeof *spirv && spirv[i] >> SpvWordCountShift;
         i += spirv[i] >> SpvWordCountShift) {
        if ((spirv[i] & SpvOpCodeMask) != SpvOpCapability) {
            continue;
        }
        switch (spirv[i + 1]) {
        case SpvCapabilityShader:
        case SpvCapabilityImageQuery:
        case SpvCapabilitySampledBuffer:
            break;
        case SpvCapabilityStorageImageExtendedFormats:
            assert_null(need(TYN_NEED_shaderStorageImageExtendedFormats)->fallback);
            break;
        default:
            fail_msg("kernel %s has capability %u; engine/gpu/needs.h has no row for it",
                     kernel->name, spirv[i + 1]);
        }
    }
}

static uint32_t count(const tyn_pass_desc *pass, const tyn_kernel *k, VkDescriptorType type)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < k->num_bindings; i++) {
        n += tyn_descriptor_type(pass, &k->bindings[i]) == type;
    }
    return n;
}

static void of_kernels(void **state)
{
    (void)state;
    uint32_t threads = 0, side = 0, images = 0, buffers = 0, sampled = 0, samplers = 0;
#define MOST(name, value) name = name > (value) ? name : (value)
    for (uint32_t i = 0; i < tyn_num_passes(); i++) {
        const tyn_pass_desc *pass = tyn_pass_at(i);
        for (uint32_t j = 0; j < pass->num_kernels; j++) {
            const tyn_kernel *k = &pass->kernels[j];
            check_capabilities(k, k->spirv, k->spirv_size);
            if (k->raster && k->raster->fragment) {
                check_capabilities(k, k->raster->fragment, k->raster->fragment_size);
            }
            const uint32_t filtered = count(pass, k, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
            MOST(images, count(pass, k, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE));
            MOST(buffers, count(pass, k, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER));
            MOST(sampled, filtered + count(pass, k, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER));
            MOST(samplers, filtered);
            MOST(threads, k->local_size[0] * k->local_size[1] * k->local_size[2]);
            MOST(side, k->local_size[0]);
            assert_true(k->local_size[1] <= 128 && k->local_size[2] <= 64); // Vulkan promises them
            assert_true(k->args_size <= 128 &&
                        count(pass, k, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) <= 12 &&
                        k->num_bindings + TYN_MAX_ATTACHMENTS <= 128);
        }
    }
    assert_int_equal(need(TYN_NEED_maxComputeWorkGroupInvocations)->least, threads);
    assert_int_equal(need(TYN_NEED_maxComputeWorkGroupSize)->least, side);
    assert_int_equal(need(TYN_NEED_maxPerStageDescriptorStorageImages)->least, images);
    assert_int_equal(need(TYN_NEED_maxPerStageDescriptorStorageBuffers)->least, buffers);
    assert_int_equal(need(TYN_NEED_maxPerStageDescriptorSampledImages)->least, sampled);
    assert_int_equal(need(TYN_NEED_maxPerStageDescriptorSamplers)->least, samplers);
}

// ---- devices ------------------------------------------------------------------------------------

// The chain that a device is made with has the required features and no other.
static void enabled(void **state)
{
    (void)state;
    const VkPhysicalDeviceFeatures2 *chain = tyn_requirements_get()->features;
    const VkPhysicalDeviceVulkan12Features *v12 = chain->pNext;
    const VkPhysicalDeviceVulkan13Features *v13 = v12->pNext;
    assert_null(v13->pNext);
    const struct {
        const VkBool32 *at;
        size_t bytes;
    } switches[] = {
        {(const VkBool32 *)&chain->features, sizeof chain->features},
        {&v12->samplerMirrorClampToEdge,
         sizeof *v12 - offsetof(VkPhysicalDeviceVulkan12Features, samplerMirrorClampToEdge)},
        {&v13->robustImageAccess,
         sizeof *v13 - offsetof(VkPhysicalDeviceVulkan13Features, robustImageAccess)},
    };
    uint32_t on = 0, required = 0;
    for (size_t s = 0; s < sizeof switches / sizeof *switches; s++) {
        for (size_t i = 0; i < switches[s].bytes / sizeof(VkBool32); i++) {
            on += switches[s].at[i] == VK_TRUE;
        }
    }
    const uint64_t met = tyn_needs_features(chain);
    for (uint32_t i = 0; i < TYN_NUM_NEEDS; i++) {
        const bool feature = !strcmp(need(i)->kind, "feature") && !need(i)->fallback;
        assert_int_equal(tyn_need_in(met, i), feature);
        required += feature;
    }
    assert_int_equal(on, required);
    assert_null(*tyn_requirements_get()->extensions);
}

static void own_structures_count(void **state)
{
    (void)state;
    const VkPhysicalDeviceMaintenance4Features alone = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES, .maintenance4 = VK_TRUE};
    const VkPhysicalDeviceFeatures2 chain = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                             .pNext = (void *)&alone};
    assert_int_equal(tyn_needs_features(&chain), 1ull << TYN_NEED_maintenance4);
    assert_int_equal(tyn_needs_features(NULL), 0);
}

static void one_line_for_what_is_missing(void **state)
{
    (void)state;
    char line[256];
    for (uint32_t i = 0; i < TYN_NUM_NEEDS; i++) {
        tyn_need_unmet(~(1ull << i), line);
        assert_int_equal(line[0] != 0, !need(i)->fallback);
        assert_true(!line[0] || (strstr(line, need(i)->name) && strstr(line, need(i)->use)));
        assert_true(need(i)->use[0] && (!need(i)->fallback || need(i)->fallback[0]));
    }
    tyn_need_unmet(0, line);
    assert_non_null(strstr(line, "Vulkan 1.3")); // the first of all
    tyn_need_unmet(~(1ull << TYN_NEED_maxComputeWorkGroupInvocations), line);
    assert_string_equal(line,
                        "limit maxComputeWorkGroupInvocations of 256 (workgroups of 256 threads)");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_kernels),
        cmocka_unit_test(enabled),
        cmocka_unit_test(own_structures_count),
        cmocka_unit_test(one_line_for_what_is_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
