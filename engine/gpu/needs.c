// needs.c -- which rows of the table of needs a device meets.
#include "gpu/needs.h"
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- the table ----------------------------------------------------------------------------------

#define VERSION(name, version, use, fallback) {"Vulkan", "1.3", 0, use, fallback},
#define FEATURE(name, required, own, use, fallback) {"feature", #name, 0, use, fallback},
#define LIMIT(name, least, use, fallback) {"limit", #name, least, use, fallback},
#define FORMAT(name, features, use, fallback) {"format", #name, 0, use, fallback},
#define QUEUE(name, condition, use, fallback) {"queue", #name, 0, use, fallback},
#define EXTENSION(name, use, fallback) {"extension", #name, 0, use, fallback},
static const tyn_need needs[TYN_NUM_NEEDS] = {
    TYN_NEEDS(VERSION, FEATURE, FEATURE, FEATURE, LIMIT, FORMAT, QUEUE, EXTENSION)};
#undef VERSION
#undef FEATURE
#undef LIMIT
#undef FORMAT
#undef QUEUE
#undef EXTENSION

_Static_assert(TYN_NUM_NEEDS <= 64, "a set of needs is 64 bits");

const tyn_need *tyn_needs(uint32_t *count)
{
    *count = TYN_NUM_NEEDS;
    return needs;
}

#define NONE(...)
#define ENABLED(name, required, ...) .name = required,
static const VkPhysicalDeviceVulkan13Features required13 = {
    .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
    TYN_NEEDS(NONE, NONE, NONE, ENABLED, NONE, NONE, NONE, NONE)};
static const VkPhysicalDeviceVulkan12Features required12 = {
    .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
    .pNext = (void *)&required13,
    TYN_NEEDS(NONE, NONE, ENABLED, NONE, NONE, NONE, NONE, NONE)};
static const VkPhysicalDeviceFeatures2 required = {
    .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
    .pNext = (void *)&required12,
    .features = {TYN_NEEDS(NONE, ENABLED, NONE, NONE, NONE, NONE, NONE, NONE)}};
#undef ENABLED

const tyn_requirements *tyn_requirements_get(void)
{
    static const char *const none[] = {NULL};
    static const tyn_requirements requirements = {VK_API_VERSION_1_3, &required, none};
    return &requirements;
}

void tyn_need_unmet(uint64_t met, char out[256])
{
    out[0] = 0;
    for (uint32_t i = 0; i < TYN_NUM_NEEDS && !out[0]; i++) {
        const tyn_need *n = &needs[i];
        if (!n->fallback && !tyn_need_in(met, (tyn_need_id)i)) {
            char least[32] = "";
            if (n->least) {
                snprintf(least, sizeof least, " of %u", n->least);
            }
            snprintf(out, 256, "%s %s%s (%s)", n->kind, n->name, least, n->use);
        }
    }
}

// ---- what a device has --------------------------------------------------------------------------

#define BIT(name) ((uint64_t)1 << TYN_NEED_##name)

static const void *find_in_chain(const void *chain, VkStructureType type)
{
    for (const VkBaseInStructure *s = chain; s; s = s->pNext) {
        if (s->sType == type) {
            return s;
        }
    }
    return NULL;
}

// A host may chain a promoted feature's own structure, whose only member it is, in place of the core one.
static bool is_on(const void *chain, VkStructureType core, size_t at, VkStructureType own)
{
    const char *const all = find_in_chain(chain, core), *const alone = find_in_chain(chain, own);
    return (all && *(const VkBool32 *)(all + at)) ||
           (alone && *(const VkBool32 *)(alone + sizeof(VkBaseInStructure)));
}

uint64_t tyn_needs_features(const VkPhysicalDeviceFeatures2 *enabled)
{
    uint64_t met = 0;
#define FEATURE(name, core, structure, member, own)                                                \
    met |= is_on(enabled, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_##core, offsetof(structure, member),   \
                 VK_STRUCTURE_TYPE_##own)                                                          \
               ? BIT(name)                                                                         \
               : 0;
#define F10(name, r, own, ...)                                                                     \
    FEATURE(name, FEATURES_2, VkPhysicalDeviceFeatures2, features.name, own)
#define F12(name, r, own, ...)                                                                     \
    FEATURE(name, VULKAN_1_2_FEATURES, VkPhysicalDeviceVulkan12Features, name, own)
#define F13(name, r, own, ...)                                                                     \
    FEATURE(name, VULKAN_1_3_FEATURES, VkPhysicalDeviceVulkan13Features, name, own)
    TYN_NEEDS(NONE, F10, F12, F13, NONE, NONE, NONE, NONE)
    return met;
}

uint64_t tyn_needs_limits(const VkPhysicalDeviceLimits *limits)
{
    uint64_t met = 0;
#define LIMIT(name, least, ...)                                                                    \
    met |= *(const uint32_t *)((const char *)limits + offsetof(VkPhysicalDeviceLimits, name)) >=   \
                   least                                                                           \
               ? BIT(name)                                                                         \
               : 0;
    TYN_NEEDS(NONE, NONE, NONE, NONE, LIMIT, NONE, NONE, NONE)
    return met;
}

uint64_t tyn_needs_extensions(const tyn_procs *vk, VkPhysicalDevice device)
{
    uint64_t met = 0;
    uint32_t count = 0;
    if (vk->EnumerateDeviceExtensionProperties(device, NULL, &count, NULL) != VK_SUCCESS) {
        return 0;
    }
    VkExtensionProperties *listed = calloc(count ? count : 1, sizeof *listed);
    if (!listed ||
        vk->EnumerateDeviceExtensionProperties(device, NULL, &count, listed) != VK_SUCCESS) {
        count = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
// Names of extensions are macros of Vulkan's headers: nothing else may take `name`.
#define EXTENSION(name, ...)                                                                       \
    met |= (uint64_t)!strcmp(listed[i].extensionName, #name) << TYN_NEED_##name;
        TYN_NEEDS(NONE, NONE, NONE, NONE, NONE, NONE, NONE, EXTENSION)
    }
    free(listed);
    return met;
}

static uint64_t queue_rows(const tyn_procs *vk, VkPhysicalDevice device, uint32_t queue_family)
{
    uint64_t met = 0;
    uint32_t count = 0;
    vk->GetPhysicalDeviceQueueFamilyProperties(device, &count, NULL);
    VkQueueFamilyProperties *families = calloc(count ? count : 1, sizeof *families);
    if (families && queue_family < count) {
        const VkQueueFamilyProperties *const family = &families[queue_family];
        vk->GetPhysicalDeviceQueueFamilyProperties(device, &count, families);
#define QUEUE(name, condition, ...) met |= (condition) ? BIT(name) : 0;
        TYN_NEEDS(NONE, NONE, NONE, NONE, NONE, NONE, QUEUE, NONE)
    }
    free(families);
    return met;
}

static bool has_format(const tyn_procs *vk, VkPhysicalDevice device, VkFormat format,
                       VkFormatFeatureFlags features)
{
    VkFormatProperties p;
    vk->GetPhysicalDeviceFormatProperties(device, format, &p);
    return (p.optimalTilingFeatures & features) == features;
}

uint64_t tyn_needs_of_device(const tyn_procs *vk, VkPhysicalDevice device, uint32_t queue_family)
{
    VkPhysicalDeviceProperties2 known = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk->GetPhysicalDeviceProperties2(device, &known);
    uint64_t met = tyn_needs_limits(&known.properties.limits) | tyn_needs_extensions(vk, device) |
                   queue_rows(vk, device, queue_family);
#define VERSION(name, version, ...) met |= known.properties.apiVersion >= (version) ? BIT(name) : 0;
#define FORMAT(name, features, ...)                                                                \
    met |= has_format(vk, device, VK_FORMAT_##name, VK_FORMAT_FEATURE_##features) ? BIT(name) : 0;
    TYN_NEEDS(VERSION, NONE, NONE, NONE, NONE, FORMAT, NONE, NONE)
    if (known.properties.apiVersion >= VK_API_VERSION_1_3) { // which knows the structures
        VkPhysicalDeviceVulkan13Features v13 = {
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
        VkPhysicalDeviceVulkan12Features v12 = {
            .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13};
        VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                              .pNext = &v12};
        vk->GetPhysicalDeviceFeatures2(device, &features);
        met |= tyn_needs_features(&features);
    }
    return met;
}
