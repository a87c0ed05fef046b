// pipeline_blob.c -- the pipeline cache as bytes that a host keeps: the driver's, behind a header that tells whose they are
// and whether they are whole. Vulkan lets a driver trust what it is given.
#include "base/given.h"
#include <tyndall/extend/hash.h>
#include "gpu/device.h"

typedef struct blob_header {
    char magic[8];
    uint32_t version; // of this header; read as another number where bytes are in another order
    uint32_t vendor, device, driver;
    uint8_t uuid[VK_UUID_SIZE]; // pipelineCacheUUID
    uint64_t size;              // of the driver's bytes, which follow
    uint64_t checksum;          // of all but itself
} blob_header;
static const char blob_magic[8] = "TYNPIPES";
enum { BLOB_VERSION = 1 };

static blob_header header_of(const tyn_device *dev, const void *bytes, size_t size)
{
    blob_header h = {.version = BLOB_VERSION,
                     .vendor = dev->properties.vendorID,
                     .device = dev->properties.deviceID,
                     .driver = dev->properties.driverVersion,
                     .size = size};
    memcpy(h.magic, blob_magic, sizeof h.magic);
    memcpy(h.uuid, dev->properties.pipelineCacheUUID, sizeof h.uuid);
    h.checksum = tyn_hash_bytes(TYN_HASH_SEED, &h, offsetof(blob_header, checksum));
    h.checksum = tyn_hash_bytes(h.checksum, bytes, size);
    return h;
}

// What is wrong with a blob, or NULL.
static const char *fault_of(const tyn_device *dev, const void *blob, size_t size)
{
    blob_header given;
    if (size < sizeof given) {
        return "it is cut off";
    }
    memcpy(&given, blob, sizeof given);
    if (memcmp(given.magic, blob_magic, sizeof given.magic) != 0) {
        return "it is none of tyn_device_pipeline_cache";
    }
    if (given.version != BLOB_VERSION) {
        return "it is of another version of Tyndall";
    }
    if (given.size != size - sizeof given) {
        return "it is cut off";
    }
    const blob_header mine = header_of(dev, (const char *)blob + sizeof given, given.size);
    if (given.vendor != mine.vendor || given.device != mine.device) {
        return "it is of another device";
    }
    if (given.driver != mine.driver || memcmp(given.uuid, mine.uuid, sizeof mine.uuid) != 0) {
        return "it is of another driver";
    }
    return given.checksum != mine.checksum ? "it is damaged" : NULL;
}

static VkResult create_cache(tyn_device *dev, const void *bytes, size_t size)
{
    return TYN_VK_MADE(&dev->cache, dev->vk.CreatePipelineCache(
                                        dev->device,
                                        &(VkPipelineCacheCreateInfo){
                                            .sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                            .initialDataSize = size,
                                            .pInitialData = bytes},
                                        NULL, &dev->cache));
}

tyn_result tyn_pipeline_cache_create(tyn_device *dev, const void *blob, size_t size)
{
    const bool given = blob && size;
    const char *fault = given ? fault_of(dev, blob, size) : NULL;
    VkResult made = VK_INCOMPLETE;
    if (given && !fault) {
        made =
            create_cache(dev, (const char *)blob + sizeof(blob_header), size - sizeof(blob_header));
        fault = made == VK_SUCCESS ? NULL : "the driver refuses it";
    }
    if (fault) {
        tyn_log_print(&dev->log, TYN_LOG_WARN,
                      "pipeline_cache is ignored, as %s; pipelines are compiled anew", fault);
    }
    made = made == VK_SUCCESS ? made : create_cache(dev, NULL, 0);
    return tyn_vk_check(dev, made, "vkCreatePipelineCache");
}

tyn_result tyn_device_pipeline_cache(tyn_device *dev, void *blob, size_t *size)
{
    if (!dev || !TYN_GIVEN(&dev->log, size)) {
        return TYN_ERR_PARAMS;
    }
    const size_t room = *size;
    size_t bytes = 0;
    VkResult got = dev->vk.GetPipelineCacheData(dev->device, dev->cache, &bytes, NULL);
    *size = got == VK_SUCCESS ? sizeof(blob_header) + bytes : 0;
    if (!blob || got != VK_SUCCESS) {
        return tyn_vk_check(dev, got, "vkGetPipelineCacheData");
    }
    *size = 0;
    if (room < sizeof(blob_header)) {
        return TYN_FAULT(
            &dev->log, TYN_ERR_PARAMS,
            "tyn_device_pipeline_cache: %zu bytes are too few; a call with blob NULL tells "
            "how many it takes",
            room);
    }
    // Never more than there is: not every driver says how much it wrote.
    bytes = bytes < room - sizeof(blob_header) ? bytes : room - sizeof(blob_header);
    char *to = (char *)blob + sizeof(blob_header);
    got = dev->vk.GetPipelineCacheData(dev->device, dev->cache, &bytes, to);
    got = got == VK_INCOMPLETE ? VK_SUCCESS : got; // what has room, which is whole in itself
    if (got == VK_SUCCESS) {
        const blob_header header = header_of(dev, to, bytes);
        memcpy(blob, &header, sizeof header);
        *size = sizeof header + bytes;
    }
    return tyn_vk_check(dev, got, "vkGetPipelineCacheData");
}
