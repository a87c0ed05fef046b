// kernels.c -- what another device's compiler makes of the kernels that scenes use: time, registers, spills, waves, code.
//
// usage: kernels DEVICE METHOD SCENE...           a line of CSV for each variant (tools/kernels has the columns); SCENE: of samples/scenes
//        kernels --check DEVICE METHOD SCENE...   exits with 1 where one passes a limit below, and with 77 without DEVICE
//
// Scenes are rendered on the software device, or on DEVICE where there is none. Each pipeline of theirs is then compiled on DEVICE
// (part of its name), with the constants that a card has. Mesa's drivers for AMD do that without a card: RADV_FORCE_FAMILY=navi21 and DEVICE RADV (tools/kernels).
#include "gpu/compiler.h"
#include "gpu/device.h"
#include "gpu/specialize.h"
#include "passes/raymarch/raymarch_args.h"
#include "passes/shade/shade_args.h"
#include "shaders/path/path_args.h"
#include "skip.h"
#include "todo.h"
#include <tyndall/io.h>
#include <tyndall/offline.h>
#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

// ---- statistics of the driver -------------------------------------------------------------------

// One line of the table. Drivers name figures as they like.
typedef struct figures {
    double registers, spilled, waves, code, scratch, shared;
} figures;

static const struct {
    const char *name; // of RADV, then NVIDIA's
    size_t at;
} names[] = {
    {"VGPRs", offsetof(figures, registers)},
    {"Register Count", offsetof(figures, registers)},
    {"Spilled VGPRs", offsetof(figures, spilled)},
    {"Subgroups per SIMD", offsetof(figures, waves)},
    {"Code size", offsetof(figures, code)},
    {"Binary Size", offsetof(figures, code)},
    {"Scratch size", offsetof(figures, scratch)},
    {"Local Memory Size", offsetof(figures, scratch)},
    {"LDS size", offsetof(figures, shared)},
    {"Shared Memory Size", offsetof(figures, shared)},
};

static figures last; // of the pipeline made last

// ---- pipelines that keep statistics: functions between the library and Vulkan -----------------------

static PFN_vkGetInstanceProcAddr real_get;
static PFN_vkGetDeviceProcAddr real_device_get;
static PFN_vkCreateDevice real_create_device;
static PFN_vkCreateComputePipelines real_compute;
static PFN_vkCreateGraphicsPipelines real_graphics;
static PFN_vkGetPipelineExecutablePropertiesKHR get_properties;
static PFN_vkGetPipelineExecutableStatisticsKHR get_statistics;
static bool keeps_statistics;

static VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical,
                                                    const VkDeviceCreateInfo *info,
                                                    const VkAllocationCallbacks *allocator,
                                                    VkDevice *out)
{
    enum { MOST = 32 };
    const char *extensions[MOST];
    VkDeviceCreateInfo with = *info;
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR feature = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pNext = (void *)info->pNext,
        .pipelineExecutableInfo = VK_TRUE};
    if (!keeps_statistics || info->enabledExtensionCount >= MOST) {
        return real_create_device(physical, info, allocator, out);
    }
    for (uint32_t i = 0; i < info->enabledExtensionCount; i++) {
        extensions[i] = info->ppEnabledExtensionNames[i];
    }
    extensions[with.enabledExtensionCount++] = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
    with.ppEnabledExtensionNames = extensions;
    with.pNext = &feature;
    return real_create_device(physical, &with, allocator, out);
}

static double value_of(const VkPipelineExecutableStatisticKHR *s)
{
    switch (s->format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
        return (double)s->value.i64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
        return (double)s->value.u64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR:
        return s->value.f64;
    default:
        return s->value.b32;
    }
}

// Of all stages the most.
static void read_statistics(VkDevice device, VkPipeline pipeline)
{
    enum { STAGES = 4, MOST = 64 };
    VkPipelineExecutablePropertiesKHR stages[STAGES];
    VkPipelineExecutableStatisticKHR found[MOST];
    uint32_t num_stages = STAGES;
    last = (figures){0};
    for (uint32_t i = 0; i < STAGES; i++) {
        stages[i] = (VkPipelineExecutablePropertiesKHR){
            .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR};
    }
    const VkPipelineInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR,
                                    .pipeline = pipeline};
    if (get_properties(device, &info, &num_stages, stages) != VK_SUCCESS) {
        return;
    }
    for (uint32_t stage = 0; stage < num_stages; stage++) {
        uint32_t count = MOST;
        for (uint32_t i = 0; i < MOST; i++) {
            found[i] = (VkPipelineExecutableStatisticKHR){
                .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR};
        }
        get_statistics(
            device,
            &(VkPipelineExecutableInfoKHR){.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
                                           .pipeline = pipeline,
                                           .executableIndex = stage},
            &count, found);
        for (uint32_t i = 0; i < count; i++) {
            for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
                double *to = (double *)((char *)&last + names[k].at);
                if (strcmp(found[i].name, names[k].name) == 0 && value_of(&found[i]) > *to) {
                    *to = value_of(&found[i]);
                }
            }
        }
    }
}

static const VkPipelineCreateFlags kept = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;

static VKAPI_ATTR VkResult VKAPI_CALL create_compute(VkDevice device, VkPipelineCache cache,
                                                     uint32_t count,
                                                     const VkComputePipelineCreateInfo *infos,
                                                     const VkAllocationCallbacks *allocator,
                                                     VkPipeline *out)
{
    VkComputePipelineCreateInfo info = *infos; // the library makes one at a time
    info.flags |= kept;
    const VkResult result = real_compute(device, cache, count, &info, allocator, out);
    if (result == VK_SUCCESS) {
        read_statistics(device, *out);
    }
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_graphics(VkDevice device, VkPipelineCache cache,
                                                      uint32_t count,
                                                      const VkGraphicsPipelineCreateInfo *infos,
                                                      const VkAllocationCallbacks *allocator,
                                                      VkPipeline *out)
{
    VkGraphicsPipelineCreateInfo info = *infos;
    info.flags |= kept;
    const VkResult result = real_graphics(device, cache, count, &info, allocator, out);
    if (result == VK_SUCCESS) {
        read_statistics(device, *out);
    }
    return result;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device,
                                                                    const char *name)
{
    const PFN_vkVoidFunction real = real_device_get(device, name);
    if (keeps_statistics && strcmp(name, "vkCreateComputePipelines") == 0) {
        get_properties = (PFN_vkGetPipelineExecutablePropertiesKHR)real_device_get(
            device, "vkGetPipelineExecutablePropertiesKHR");
        get_statistics = (PFN_vkGetPipelineExecutableStatisticsKHR)real_device_get(
            device, "vkGetPipelineExecutableStatisticsKHR");
        real_compute = (PFN_vkCreateComputePipelines)real;
        return (PFN_vkVoidFunction)create_compute;
    }
    if (keeps_statistics && strcmp(name, "vkCreateGraphicsPipelines") == 0) {
        real_graphics = (PFN_vkCreateGraphicsPipelines)real;
        return (PFN_vkVoidFunction)create_graphics;
    }
    return real;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_function(VkInstance instance, const char *name)
{
    const PFN_vkVoidFunction real = real_get(instance, name);
    if (real && strcmp(name, "vkCreateDevice") == 0) {
        real_create_device = (PFN_vkCreateDevice)real;
        return (PFN_vkVoidFunction)create_device;
    }
    if (real && strcmp(name, "vkGetDeviceProcAddr") == 0) {
        real_device_get = (PFN_vkGetDeviceProcAddr)real;
        return (PFN_vkVoidFunction)get_device_function;
    }
    return real;
}

// ---- limits --------------------------------------------------------------------------------------

// Of a module as the driver has it, bytes; registers spilled; waves a SIMD (a NAVI21 has 16 at most).
typedef struct limit {
    const char *kernel;
    size_t bytes;
    double spilled, waves;
    const char *why; // it passes those of all
    bool met;        // some variant did
} limit;

static const limit of_all = {"", 65536, 0, 8, NULL, false};

// About a tenth above what is seen.
static limit known[] = {
    {"raymarch_grey", 212000, 0, 4,
     "lamps, walls, the sparse march and what is behind the medium in one kernel", false},
    {"lattice_lamps_vpls", 65536, 0, 4, "moments of eight cells at once, in three channels", false},
    {"shade_surface", 204000, 0, 8, "all lights of a surface, of whole pixels and of pieces",
     false},
    {"shade_alone", 108500, 0, 8, "as shade_surface, without a list", false},
    {"shade_vpls", 114000, 0, 4, "virtual lights with their lobes, and the sky", false},
};
enum { NUM_KNOWN = sizeof known / sizeof *known };

static bool is_within(const limit *l, size_t bytes, const figures *f)
{
    return bytes <= l->bytes && f->spilled <= l->spilled && f->waves >= l->waves;
}

static bool check_limits(const char *kernel, const char *constants, size_t bytes, const figures *f)
{
    limit *own = NULL;
    for (size_t i = 0; i < NUM_KNOWN; i++) {
        own = strcmp(known[i].kernel, kernel) == 0 ? &known[i] : own;
    }
    const bool holds = is_within(&of_all, bytes, f), todo = own && is_within(own, bytes, f);
    if (own && !holds) {
        own->met = true;
    }
    return holds || todo_if(todo, false, own ? own->why : "",
                            "%s (%s): %zu bytes, %.0f registers spilled, %.0f waves", kernel,
                            constants, bytes, f->spilled, f->waves);
}

// False, and said, where a mark has to go.
static bool check_marks(void)
{
    bool good = true;
    for (size_t i = 0; i < NUM_KNOWN; i++) {
        good = (known[i].met || todo_if(true, true, known[i].why, "%s", known[i].kernel)) && good;
    }
    return good;
}

// ---- the table -----------------------------------------------------------------------------------

static void say(void *user, tyn_log_level level, const char *message)
{
    (void)user;
    if (level == TYN_LOG_ERROR) {
        fprintf(stderr, "kernels: %s\n", message);
    }
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static uint32_t index_of(const tyn_pass_desc *pass, const tyn_kernel *kernel)
{
    uint32_t i = 0;
    while (&pass->kernels[i] != kernel) {
        i++;
    }
    return i;
}

static size_t specialised_size(const tyn_kernel *k, const uint32_t *spec)
{
    uint32_t *words = malloc(k->spirv_size);
    const size_t count = words ? tyn_spirv_specialize(k->spirv, k->spirv_size / sizeof *words, spec,
                                                      k->num_spec, words)
                               : 0;
    free(words);
    return count * sizeof *words;
}

// Constants as a card has them: on a processor `path` keeps few triangles in registers, `raymarch` and `shade` have a
// kernel for what they list, and a thread of `shade` takes all light of what is listed.
static void constants_of_card(const tyn_kernel *k, const uint32_t *from, uint32_t *spec)
{
    memcpy(spec, from, k->num_spec * sizeof *spec);
    if (strncmp(k->name, "path_", 5) == 0 && k->num_spec == TYN_PATH_NUM_SPEC) {
        spec[TYN_PATH_SPEC_FLAGS] &= ~(TYN_PATH_KEEP_FEW | TYN_PATH_SHORT_LOOPS);
    }
    const uint32_t rays = RAYMARCH_SPARSE_NODES | RAYMARCH_SPARSE_PIXELS;
    if (strncmp(k->name, "raymarch_", 9) == 0 && spec[RAYMARCH_SPEC_FEATURES] & rays) {
        spec[RAYMARCH_SPEC_FEATURES] |= rays;
    }
    if (strcmp(k->name, "shade_vpls") == 0 || strcmp(k->name, "shade_gather") == 0) {
        spec[SHADE_SPEC_FEATURES] |= SHADE_SLICED;
    }
    if (strcmp(k->name, "shade_surface") == 0) {
        spec[SHADE_SPEC_FEATURES] |= SHADE_PIXELS | SHADE_EDGES;
    }
}

// One variant, made on the other device. False: it fails, or passes a limit.
static bool measure(tyn_device *dev, const tyn_pipeline *from, const uint32_t *variant, bool check)
{
    const tyn_kernel *k = from->kernel;
    uint32_t spec[TYN_MAX_SPEC];
    constants_of_card(k, variant, spec);
    tyn_pipeline *to = NULL;
    VkPipeline made = VK_NULL_HANDLE;
    bool cached = false;
    if (tyn_pipeline_get(dev, from->pass, index_of(from->pass, k), &to) != TYN_OK) {
        return false;
    }
    const double begin = now_ms();
    const VkResult result = tyn_pipeline_compile(dev, to, spec, &made, &cached);
    const double ms = now_ms() - begin;
    if (result != VK_SUCCESS) {
        fprintf(stderr, "kernels: %s: VkResult %d\n", k->name, (int)result);
        return false;
    }
    dev->vk.DestroyPipeline(dev->device, made, NULL);
    char constants[16 * TYN_MAX_SPEC] = "";
    for (uint32_t i = 0; i < k->num_spec; i++) {
        const size_t at = strlen(constants);
        snprintf(constants + at, sizeof constants - at, i ? " %u" : "%u", spec[i]);
    }
    const size_t bytes = specialised_size(k, spec);
    if (check) {
        return check_limits(k->name, constants, bytes, &last);
    }
    printf("%s,%s,%zu,%.1f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f\n", k->name, constants, bytes, ms,
           last.registers, last.spilled, last.waves, last.code, last.scratch, last.shared);
    return true;
}

static bool render(tyn_device *dev, const char *method, const char *name, const tyn_log *log)
{
    char path[512];
    tyn_scene scene;
    tyn_view view;
    tyn_offline *off = NULL;
    const char *folder = getenv("TYN_SAMPLE_SCENES"); // of a tree that was carried elsewhere
    snprintf(path, sizeof path, "%s/%s.gltf", folder ? folder : TYN_SAMPLE_SCENES, name);
    tyn_scene_init(&scene);
    memset(&view, 0, sizeof view);
    bool fine = tyn_scene_load(&scene, path, NULL, log) == TYN_OK &&
                tyn_surfaces_build_nodes(&scene.surfaces, log) == TYN_OK;
    if (fine && scene.num_cameras) {
        view.camera = scene.cameras[0];
    } else if (fine) {
        tyn_camera_frame_scene(&view.camera, &scene);
    }
    view.outputs = TYN_OUTPUT_RADIANCE;
    view.width = view.height = 32;
    view.num_samples = 1;
    fine = fine && tyn_offline_create(dev, tyn_offline_params(.method = method), &off) == TYN_OK &&
           tyn_offline_frame(off, &scene, &view, false) == TYN_OK;
    tyn_offline_destroy(&off);
    tyn_scene_finish(&scene);
    return fine;
}

static bool open_loader(void)
{
    void *loader = dlopen("libvulkan.so.1", RTLD_NOW);
    void *function = loader ? dlsym(loader, "vkGetInstanceProcAddr") : NULL;
    memcpy(&real_get, &function, sizeof real_get);
    return function != NULL;
}

// The device that renders. A machine with a card may lack the software device.
static bool open_renderer(const char *card, const tyn_log *log, tyn_device **out)
{
    return tyn_device_open(tyn_device_open_params(.select = "llvmpipe"), out) == TYN_OK ||
           tyn_device_open(tyn_device_open_params(.select = card, .log = *log), out) == TYN_OK;
}

int main(int argc, char **argv)
{
    const bool check = argc > 1 && strcmp(argv[1], "--check") == 0;
    const int first = check ? 2 : 1;
    if (argc < first + 3) {
        fprintf(stderr, "usage: kernels [--check] DEVICE METHOD SCENE...\n");
        return 2;
    }
    const tyn_log log = {.fn = say};
    tyn_device *from = NULL, *to = NULL;
    bool fine = open_loader() && open_renderer(argv[first], &log, &from);
    keeps_statistics = true;
    const bool there =
        fine && tyn_device_open(tyn_device_open_params(.select = argv[first], .log = log,
                                                       .get_instance_proc_addr = get_function),
                                &to) == TYN_OK;
    for (int i = first + 2; there && fine && i < argc; i++) {
        fine = render(from, argv[first + 1], argv[i], &log);
    }
    const bool rendered = there && fine;
    for (uint32_t i = 0; rendered && i < from->num_pipelines; i++) {
        for (const tyn_variant *v = from->pipelines[i]->variants; v; v = v->next) {
            fine = measure(to, from->pipelines[i], v->spec, check) && fine;
        }
    }
    fine = fine && (!check || !there || check_marks());
    tyn_device_destroy(&from); // not `to`: Mesa's driver without a card ends in vkDestroyDevice
    if (fine && !there && check) {
        skip_all("no device %s", argv[first]);
    }
    if (!there) {
        fprintf(stderr, "kernels: no device %s with VK_KHR_pipeline_executable_properties\n",
                argv[first]);
    }
    return fine && there ? 0 : 1;
}
