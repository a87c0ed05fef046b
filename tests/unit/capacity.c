// capacity.c -- how many threads a device holds by what its driver tells, and the sizes of dispatches that follow.
#include <tyndall/extend/dispatch_sizes.h>
#include "gpu/device.h"
#include "shaders/path/path_args.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

// ---- a driver ---------------------------------------------------------------------------------

typedef struct card {
    VkPhysicalDeviceType type;
    const char *extensions[2];
    VkPhysicalDeviceShaderSMBuiltinsPropertiesNV nv;
    VkPhysicalDeviceShaderCorePropertiesAMD amd;
    VkPhysicalDeviceShaderCoreProperties2AMD amd2;
    VkPhysicalDeviceShaderCoreBuiltinsPropertiesARM arm;
    uint32_t subgroup;
    bool fails;
    VkDriverId id;
} card;
static card driver; // functions of Vulkan get handles only

static VkResult list_extensions(VkPhysicalDevice device, const char *layer, uint32_t *count,
                                VkExtensionProperties *out)
{
    (void)device, (void)layer;
    uint32_t there = 0;
    while (there < 2 && driver.extensions[there]) {
        if (out) {
            strcpy(out[there].extensionName, driver.extensions[there]);
        }
        there++;
    }
    *count = there;
    return driver.fails ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_SUCCESS;
}

static bool knows(const char *extension)
{
    return (driver.extensions[0] && !strcmp(driver.extensions[0], extension)) ||
           (driver.extensions[1] && !strcmp(driver.extensions[1], extension));
}

// Nobody may ask for the properties of an extension that the device lacks.
static void tell(VkPhysicalDevice device, VkPhysicalDeviceProperties2 *all)
{
    (void)device;
    all->properties.deviceType = driver.type;
    for (VkBaseOutStructure *s = all->pNext; s; s = s->pNext) {
        VkBaseOutStructure *const next = s->pNext;
        switch ((int)s->sType) {
        case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES:
            ((VkPhysicalDeviceDriverProperties *)s)->driverID = driver.id;
            break;
        case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES:
            ((VkPhysicalDeviceSubgroupProperties *)s)->subgroupSize = driver.subgroup;
            break;
#define TELL(TYPE, name, member)                                                                   \
    case VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##TYPE:                                                 \
        assert_true(knows(name));                                                                  \
        memcpy((char *)s + sizeof *s, (char *)&driver.member + sizeof *s,                          \
               sizeof driver.member - sizeof *s);                                                  \
        break;
            TELL(SHADER_SM_BUILTINS_PROPERTIES_NV, "VK_NV_shader_sm_builtins", nv)
            TELL(SHADER_CORE_PROPERTIES_AMD, "VK_AMD_shader_core_properties", amd)
            TELL(SHADER_CORE_PROPERTIES_2_AMD, "VK_AMD_shader_core_properties2", amd2)
            TELL(SHADER_CORE_BUILTINS_PROPERTIES_ARM, "VK_ARM_shader_core_builtins", arm)
#undef TELL
        default:
            fail_msg("asked for %d", (int)s->sType);
        }
        assert_ptr_equal(s->pNext, next);
    }
}

static tyn_capacity capacity_of(card c)
{
    driver = c;
    const tyn_procs vk = {.EnumerateDeviceExtensionProperties = list_extensions,
                          .GetPhysicalDeviceProperties2 = tell};
    return tyn_device_capacity(&vk, VK_NULL_HANDLE);
}

#define DISCRETE .type = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU
#define INTEGRATED .type = VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU

static void by_the_driver(void **state)
{
    (void)state;
    const struct {
        card card;
        uint32_t threads;
    } rows[] = {
        // An NVIDIA H200: 132 multiprocessors.
        {{DISCRETE,
          {"VK_NV_shader_sm_builtins"},
          .nv = {.shaderSMCount = 132, .shaderWarpsPerSM = 64},
          .subgroup = 32},
         262144},
        // An AMD Navi 21 of 80 compute units, of which 72 work.
        {{DISCRETE,
          {"VK_AMD_shader_core_properties", "VK_AMD_shader_core_properties2"},
          .amd = {.shaderEngineCount = 4,
                  .shaderArraysPerEngineCount = 2,
                  .computeUnitsPerShaderArray = 10,
                  .simdPerComputeUnit = 2,
                  .wavefrontsPerSimd = 16,
                  .wavefrontSize = 64},
          .amd2 = {.activeComputeUnitCount = 72},
          .subgroup = 64},
         131072},
        // Two compute units in a processor's package: 4096 threads.
        {{INTEGRATED,
          {"VK_AMD_shader_core_properties"},
          .amd = {.shaderEngineCount = 1,
                  .shaderArraysPerEngineCount = 1,
                  .computeUnitsPerShaderArray = 2,
                  .simdPerComputeUnit = 2,
                  .wavefrontsPerSimd = 16,
                  .wavefrontSize = 64},
          .subgroup = 64},
         4096},
        {{INTEGRATED,
          {"VK_ARM_shader_core_builtins"},
          .arm = {.shaderCoreCount = 10, .shaderWarpsPerCore = 128},
          .subgroup = 16},
         16384},
        // Nonsense.
        {{DISCRETE,
          {"VK_NV_shader_sm_builtins"},
          .nv = {.shaderSMCount = 1u << 30, .shaderWarpsPerSM = 1u << 30},
          .subgroup = 32},
         1048576},
        {{DISCRETE,
          {"VK_NV_shader_sm_builtins"},
          .nv = {.shaderSMCount = 1, .shaderWarpsPerSM = 1},
          .subgroup = 1},
         4096},
        // Cards that do not tell.
        {{DISCRETE, .subgroup = 32}, 262144},
        {{DISCRETE, {"VK_NV_shader_sm_builtins"}, .subgroup = 32}, 262144},
        {{DISCRETE, {"VK_NV_shader_sm_builtins"}, .fails = true}, 262144},
        {{INTEGRATED, .subgroup = 32}, 8192},
        {{.type = VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU, .subgroup = 32}, 8192},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const tyn_capacity c = capacity_of(rows[i].card);
        assert_false(c.software);
        assert_int_equal(c.threads, rows[i].threads);
    }
    const tyn_capacity processor = capacity_of((card){.type = VK_PHYSICAL_DEVICE_TYPE_CPU});
    assert_true(processor.software);
    assert_false(processor.short_loops); // another one than lavapipe
    const tyn_capacity lavapipe =
        capacity_of((card){.type = VK_PHYSICAL_DEVICE_TYPE_CPU, .id = VK_DRIVER_ID_MESA_LLVMPIPE});
    assert_true(lavapipe.software && lavapipe.short_loops);
}

// ---- sizes ------------------------------------------------------------------------------------

static void of_a_processor(void **state)
{
    (void)state;
    const tyn_capacity processor = {.software = true};
    static const uint32_t figures[TYN_NUM_DISPATCH_SIZES] = {16384, 1024, 16384, 512, 4096,
                                                             1,     1024, 65536, 20,  1000};
    for (int i = 0; i < TYN_NUM_DISPATCH_SIZES; i++) {
        assert_int_equal(tyn_dispatch_size_of(&processor, (tyn_dispatch_size)i), figures[i]);
    }
}

static void of_cards(void **state)
{
    (void)state;
    for (uint32_t threads = 4096; threads <= 1 << 20; threads *= 2) {
        const tyn_capacity holds = {.threads = threads};
        const uint64_t path = tyn_dispatch_size_of(&holds, TYN_SIZE_PATH_THREADS),
                       balance = tyn_dispatch_size_of(&holds, TYN_SIZE_BALANCE_THREADS),
                       fluxes = tyn_dispatch_size_of(&holds, TYN_SIZE_FLUX_THREADS);
        assert_true(path >= 8192 && path <= 1048576);
        assert_true(path == 8192 || path == 1048576 || path == 2ull * threads);
        assert_true(tyn_dispatch_size_of(&holds, TYN_SIZE_PATH_LONG) <= path);
        assert_true(tyn_dispatch_size_of(&holds, TYN_SIZE_PHOTONS_LEAST) <=
                    tyn_dispatch_size_of(&holds, TYN_SIZE_PHOTONS_MOST));
        assert_true(4096 % fluxes == 0 && fluxes % TYN_PATH_FLUX_LANES == 0);
        // What Vulkan promises for a storage buffer.
        const uint64_t most = 1u << 27;
        assert_true(path * sizeof(struct path_partial) <= most);
        assert_true(path * sizeof(struct path_partial_layers) <= most);
        assert_true(path * sizeof(struct path_probe_partial) <= most);
        assert_true(balance * sizeof(struct path_balance_partial) <= most);
        assert_true(fluxes * TYN_PATH_FLUX_VALUES * sizeof(float) <= most);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(by_the_driver),
                                       cmocka_unit_test(of_a_processor),
                                       cmocka_unit_test(of_cards)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
