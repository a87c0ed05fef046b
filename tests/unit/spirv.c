// spirv.c -- every table of every pass against the SPIR-V it stands for, so that they cannot drift.
#include "spirv_reflect.h"
#include <tyndall/registry.h>
#include <spirv/unified1/spirv.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static int faults;
static bool quiet; // the tests of the check itself expect faults

static void fault(const tyn_pass_desc *pass, const char *kernel, const char *format, ...)
{
    faults++;
    if (!quiet) {
        va_list args;
        va_start(args, format);
        fprintf(stderr, "pass %s, %s: ", pass->name, kernel);
        vfprintf(stderr, format, args);
        fputc('\n', stderr);
        va_end(args);
    }
}

// ---- shaders --------------------------------------------------------------------------------

static uint32_t spirv_format(VkFormat format)
{
    static const struct {
        VkFormat vk;
        SpvImageFormat spv;
    } table[] = {
        {VK_FORMAT_R32G32B32A32_SFLOAT, SpvImageFormatRgba32f},
        {VK_FORMAT_R16G16B16A16_SFLOAT, SpvImageFormatRgba16f},
        {VK_FORMAT_R32G32_SFLOAT, SpvImageFormatRg32f},
        {VK_FORMAT_R16G16_SFLOAT, SpvImageFormatRg16f},
        {VK_FORMAT_R32_SFLOAT, SpvImageFormatR32f},
        {VK_FORMAT_R16_SFLOAT, SpvImageFormatR16f},
        {VK_FORMAT_R8G8B8A8_UNORM, SpvImageFormatRgba8},
        {VK_FORMAT_R8_UNORM, SpvImageFormatR8},
        {VK_FORMAT_B10G11R11_UFLOAT_PACK32, SpvImageFormatR11fG11fB10f},
        {VK_FORMAT_R32_UINT, SpvImageFormatR32ui},
        {VK_FORMAT_R32G32_UINT, SpvImageFormatRg32ui},
        {VK_FORMAT_R32G32B32A32_UINT, SpvImageFormatRgba32ui},
        {VK_FORMAT_R8_UINT, SpvImageFormatR8ui},
        {VK_FORMAT_R16_UINT, SpvImageFormatR16ui},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        if (table[i].vk == format) {
            return (uint32_t)table[i].spv;
        }
    }
    return SpvImageFormatUnknown;
}

typedef struct shaders { // of a kernel
    reflect_shader at[2];
    int num;
} shaders;

// Reads a module once: the tests ask for each of them many times.
static bool reflect_once(const uint32_t *spirv, size_t size, reflect_shader *out, const char **why)
{
    enum { MODULES = 1024 };
    static struct {
        const uint32_t *spirv;
        reflect_shader shader;
    } known[MODULES];
    size_t slot = ((uintptr_t)spirv >> 5) % MODULES;
    if (known[slot].spirv != spirv || !spirv) {
        if (!reflect(spirv, size, out, why)) {
            return false;
        }
        known[slot].spirv = spirv;
        known[slot].shader = *out;
    }
    *out = known[slot].shader;
    return true;
}

static bool reflect_kernel(const tyn_kernel *kernel, shaders *out, const char **why)
{
    const tyn_raster *raster = kernel->raster;
    out->num = raster && raster->fragment ? 2 : 1;
    return reflect_once(kernel->spirv, kernel->spirv_size, &out->at[0], why) &&
           (out->num == 1 ||
            reflect_once(raster->fragment, raster->fragment_size, &out->at[1], why));
}

// Does some kernel store to this port in the format of the port table? (A pass may have variants of
// a kernel in other formats, chosen together with tyn_build_format.)
static bool stored_as_declared(const tyn_pass_desc *pass, uint8_t port)
{
    for (uint32_t k = 0; k < pass->num_kernels; k++) {
        const tyn_kernel *kernel = &pass->kernels[k];
        reflect_shader shader;
        const char *why;
        if (kernel->raster || !reflect_once(kernel->spirv, kernel->spirv_size, &shader, &why)) {
            continue;
        }
        for (uint32_t i = 0; i < shader.num_bindings; i++) {
            const reflect_binding *b = &shader.bindings[i];
            if (b->kind == REFLECT_STORAGE_IMAGE && b->binding < kernel->num_bindings &&
                kernel->bindings[b->binding].port == port &&
                b->format == spirv_format(pass->ports[port].format)) {
                return true;
            }
        }
    }
    return false;
}

static void check_image(const tyn_pass_desc *pass, const tyn_kernel *kernel, const tyn_port *port,
                        const reflect_binding *b)
{
    tyn_dim dim = b->dim == SpvDim3D   ? TYN_IMAGE_3D
                  : b->dim == SpvDim2D ? TYN_IMAGE_2D
                                       : TYN_BUFFER;
    if (dim != port->dim || b->arrayed || b->multisampled) {
        fault(pass, kernel->name, "binding %u, port %s: other image dimensions in the shader",
              b->binding, port->name);
    }
    if (b->kind != REFLECT_STORAGE_IMAGE) {
        return;
    }
    if (b->format == SpvImageFormatUnknown) {
        fault(pass, kernel->name, "binding %u, port %s: the shader gives no format", b->binding,
              port->name);
    } else if (b->format != spirv_format(port->format) &&
               !stored_as_declared(pass, (uint8_t)(port - pass->ports))) {
        fault(pass, kernel->name, "binding %u, port %s: format of the shader is not the port's",
              b->binding, port->name);
    }
}

static void check_access(const tyn_pass_desc *pass, const tyn_kernel *kernel, tyn_use use,
                         const char *port, const reflect_binding *b)
{
    bool read = use == TYN_USE_STORAGE_READ, write = use == TYN_USE_STORAGE_WRITE;
    if (b->non_writable != read || b->non_readable != write) {
        fault(pass, kernel->name, "binding %u, port %s: the shader says %s, the table %s",
              b->binding, port,
              b->non_writable   ? "readonly"
              : b->non_readable ? "writeonly"
                                : "read and write",
              read    ? "readonly"
              : write ? "writeonly"
                      : "read and write");
    }
}

static void check_binding(const tyn_pass_desc *pass, const tyn_kernel *kernel,
                          const reflect_binding *b)
{
    if (b->set != 0 || b->binding >= kernel->num_bindings) {
        fault(pass, kernel->name, "set %u binding %u of the shader is not in the table", b->set,
              b->binding);
        return;
    }
    const tyn_binding *entry = &kernel->bindings[b->binding];
    if (entry->port >= pass->num_ports) {
        return; // reported by check_tables
    }
    const tyn_port *port = &pass->ports[entry->port];
    bool image = port->dim != TYN_BUFFER;
    reflect_kind wanted = REFLECT_OTHER;
    switch (entry->use) {
    case TYN_USE_SAMPLED:
        wanted = image ? REFLECT_SAMPLED_IMAGE : REFLECT_OTHER;
        break;
    case TYN_USE_UNIFORM:
        wanted = image ? REFLECT_OTHER : REFLECT_UNIFORM_BUFFER;
        break;
    case TYN_USE_TEXELS_FLOAT:
    case TYN_USE_TEXELS_VEC4:
    case TYN_USE_TEXELS_UINT:
    case TYN_USE_TEXELS_UVEC4:
        wanted = image ? REFLECT_OTHER : REFLECT_TEXELS;
        break;
    case TYN_USE_STORAGE_READ:
    case TYN_USE_STORAGE_WRITE:
    case TYN_USE_STORAGE_RW:
        wanted = image ? REFLECT_STORAGE_IMAGE : REFLECT_STORAGE_BUFFER;
        break;
    default:
        break;
    }
    if (wanted == REFLECT_OTHER || b->kind != wanted) {
        fault(pass, kernel->name, "binding %u, port %s: another kind of descriptor in the shader",
              b->binding, port->name);
        return;
    }
    if (image) {
        check_image(pass, kernel, port, b);
    }
    const bool floats = entry->use == TYN_USE_TEXELS_FLOAT || entry->use == TYN_USE_TEXELS_VEC4;
    if (wanted == REFLECT_TEXELS && b->float_texels != floats) {
        fault(pass, kernel->name, "binding %u, port %s: another kind of texels in the shader",
              b->binding, port->name);
    }
    if (wanted == REFLECT_STORAGE_BUFFER || wanted == REFLECT_STORAGE_IMAGE) {
        check_access(pass, kernel, entry->use, port->name, b);
    }
}

// What every device that meets our requirements has.
static bool capability_known(uint32_t capability)
{
    switch (capability) {
    case SpvCapabilityShader:
    case SpvCapabilityImageQuery:
    case SpvCapabilitySampledBuffer:
    case SpvCapabilityStorageImageExtendedFormats: // core formats beyond the short list
        return true;
    default:
        return false;
    }
}

static void check_compute(const tyn_pass_desc *pass, const tyn_kernel *kernel,
                          const reflect_shader *shader)
{
    if (!shader->compute) {
        fault(pass, kernel->name, "is not a compute shader");
    }
    if (memcmp(shader->local_size, kernel->local_size, sizeof shader->local_size) != 0) {
        fault(pass, kernel->name, "local size %ux%ux%u in the shader, %ux%ux%u in the table",
              shader->local_size[0], shader->local_size[1], shader->local_size[2],
              kernel->local_size[0], kernel->local_size[1], kernel->local_size[2]);
    }
    if (shader->local_size[0] * shader->local_size[1] * shader->local_size[2] > 1024) {
        fault(pass, kernel->name, "more than 1024 threads a workgroup");
    }
    if (shader->shared_bytes > 32768) {
        fault(pass, kernel->name, "%u bytes of shared memory", shader->shared_bytes);
    }
}

static void check_raster(const tyn_pass_desc *pass, const tyn_kernel *kernel, const shaders *s)
{
    const reflect_shader *vertex = &s->at[0], *fragment = s->num == 2 ? &s->at[1] : NULL;
    if (!vertex->vertex || (fragment && !fragment->fragment)) {
        fault(pass, kernel->name, "needs a vertex and a fragment shader");
    }
    if (vertex->inputs) {
        fault(pass, kernel->name, "has vertex inputs; vertices come from storage buffers");
    }
    if (fragment && (fragment->inputs & ~vertex->outputs)) {
        fault(pass, kernel->name,
              "the fragment shader reads what the vertex shader does not write");
    }
    uint32_t colors = 0, depths = 0;
    for (uint32_t i = 0; i < kernel->raster->num_attachments; i++) {
        colors += kernel->raster->attachments[i].use == TYN_USE_COLOR;
        depths += kernel->raster->attachments[i].use == TYN_USE_DEPTH;
    }
    uint32_t written = fragment ? fragment->outputs : 0;
    if (written != (1u << colors) - 1 || depths > 1 ||
        colors + depths != kernel->raster->num_attachments || colors + depths == 0) {
        fault(pass, kernel->name, "draws to locations (mask %#x), and has %u colours, %u depths",
              written, colors, depths);
    }
    if (kernel->local_size[0] | kernel->local_size[1] | kernel->local_size[2]) {
        fault(pass, kernel->name, "a raster kernel has no local size");
    }
}

static void check_kernel(const tyn_pass_desc *pass, const tyn_kernel *kernel)
{
    shaders s;
    const char *why;
    if (!reflect_kernel(kernel, &s, &why)) {
        fault(pass, kernel->name, "%s", why);
        return;
    }
    if (kernel->raster) {
        check_raster(pass, kernel, &s);
    } else {
        check_compute(pass, kernel, &s.at[0]);
    }
    uint32_t args = 0, spec_ids = 0;
    uint64_t seen = 0;
    for (int i = 0; i < s.num; i++) {
        const reflect_shader *shader = &s.at[i];
        if (shader->num_entry_points != 1 || !shader->named_main) {
            fault(pass, kernel->name, "needs one entry point \"main\"");
        }
        for (uint32_t c = 0; c < shader->num_capabilities; c++) {
            if (!capability_known(shader->capabilities[c])) {
                fault(pass, kernel->name, "needs SPIR-V capability %u", shader->capabilities[c]);
            }
        }
        if (shader->spec_wide) {
            fault(pass, kernel->name, "a specialisation constant is not of 32 bits");
        }
        for (uint32_t b = 0; b < shader->num_bindings; b++) {
            check_binding(pass, kernel, &shader->bindings[b]);
            if (shader->bindings[b].binding < 64) {
                seen |= 1ull << shader->bindings[b].binding;
            }
        }
        spec_ids |= shader->spec_ids;
        args = shader->push_constant_bytes > args ? shader->push_constant_bytes : args;
    }
    if (args != kernel->args_size || kernel->args_size > TYN_MAX_ARGS) {
        fault(pass, kernel->name, "%u bytes of push constants in the shader, %u in the table", args,
              kernel->args_size);
    }
    // Kernels of one pass may share a list of constants, so one may be unused; but not the last.
    if (spec_ids >> kernel->num_spec ||
        (kernel->num_spec && !(spec_ids >> (kernel->num_spec - 1)))) {
        fault(pass, kernel->name, "specialisation constants (mask %#x) are not 0..%d", spec_ids,
              (int)kernel->num_spec - 1);
    }
    for (uint32_t i = 0; i < kernel->num_bindings; i++) {
        if (!(seen >> i & 1)) {
            fault(pass, kernel->name, "binding %u of the table is not in the shader", i);
        }
    }
}

// ---- tables by themselves -------------------------------------------------------------------

static void check_ports(const tyn_pass_desc *pass)
{
    if (pass->num_ports > TYN_MAX_PORTS) {
        fault(pass, "ports", "more than %d", TYN_MAX_PORTS);
    }
    for (uint32_t i = 0; i < pass->num_ports; i++) {
        const tyn_port *port = &pass->ports[i];
        if (!port->name || !*port->name || !port->meaning || !*port->meaning) {
            fault(pass, "ports", "port %u lacks a name or a meaning", i);
            continue;
        }
        for (uint32_t j = 0; j < i; j++) {
            if (pass->ports[j].name && strcmp(port->name, pass->ports[j].name) == 0) {
                fault(pass, "ports", "two are called %s", port->name);
            }
        }
        bool made = port->dir == TYN_OUT || port->dir == TYN_SCRATCH;
        if (made && port->dim != TYN_BUFFER && port->format == VK_FORMAT_UNDEFINED) {
            fault(pass, "ports", "%s: an image that is made here needs a format", port->name);
        }
        if (port->optional && port->dir != TYN_IN) {
            fault(pass, "ports", "%s: only inputs can be optional", port->name);
        }
    }
    if (pass->debug_port >= pass->num_ports || !pass->debug_meaning || !*pass->debug_meaning ||
        (pass->ports[pass->debug_port].dir != TYN_OUT &&
         pass->ports[pass->debug_port].dir != TYN_INOUT)) {
        fault(pass, "ports", "the debug view must be an output with a meaning");
    }
}

static void check_uses(const tyn_pass_desc *pass, const tyn_kernel *kernel)
{
    if (kernel->num_bindings > TYN_MAX_BINDINGS || kernel->num_spec > TYN_MAX_SPEC) {
        fault(pass, kernel->name, "too many bindings or specialisation constants");
    }
    for (uint32_t i = 0; i < kernel->num_bindings; i++) {
        const tyn_binding *b = &kernel->bindings[i];
        if (b->port >= pass->num_ports) {
            fault(pass, kernel->name, "binding %u names port %u", i, b->port);
            continue;
        }
        const tyn_port *port = &pass->ports[b->port];
        bool writes = b->use == TYN_USE_STORAGE_WRITE || b->use == TYN_USE_STORAGE_RW;
        if (writes && (port->dir == TYN_IN || kernel->raster)) {
            fault(pass, kernel->name, "binding %u writes %s", i, port->name);
        }
        if (b->repeat && b->use != TYN_USE_SAMPLED) {
            fault(pass, kernel->name, "binding %u repeats but is not sampled", i);
        }
    }
    for (uint32_t i = 0; kernel->raster && i < kernel->raster->num_attachments; i++) {
        const tyn_binding *a = &kernel->raster->attachments[i];
        if (a->port >= pass->num_ports || pass->ports[a->port].dir == TYN_IN ||
            pass->ports[a->port].dim != TYN_IMAGE_2D) {
            fault(pass, kernel->name, "attachment %u is no 2D image that the pass makes", i);
        }
    }
}

static void check_params(const tyn_pass_desc *pass)
{
    for (uint32_t i = 0; i < pass->num_params; i++) {
        const tyn_param *p = &pass->params[i];
        if (!p->name || !*p->name || !p->doc || !*p->doc || !p->unit) {
            fault(pass, "params", "parameter %u lacks a name, unit or line of documentation", i);
            continue;
        }
        for (uint32_t j = 0; j < i; j++) {
            if (strcmp(p->name, pass->params[j].name) == 0 || p->offset == pass->params[j].offset) {
                fault(pass, "params", "%s and %s share a name or a place", p->name,
                      pass->params[j].name);
            }
        }
        if (!(p->min <= p->def && p->def <= p->max) || p->offset + 4 > pass->params_size) {
            fault(pass, "params", "%s: default out of range, or outside the struct", p->name);
        }
        if (p->type != TYN_PARAM_ENUM) {
            continue;
        }
        for (int v = 0; v <= (int)p->max; v++) {
            if (!p->names || !p->names[v] || !*p->names[v]) {
                fault(pass, "params", "%s: value %d has no name", p->name, v);
                break;
            }
        }
    }
}

static void check_pass(const tyn_pass_desc *pass)
{
    if (!pass->declare || !pass->record || !pass->summary || !*pass->summary) {
        fault(pass, "pass", "declare, record or summary is missing");
    }
    check_ports(pass);
    check_params(pass);
    for (uint32_t k = 0; k < pass->num_kernels; k++) {
        check_uses(pass, &pass->kernels[k]);
        check_kernel(pass, &pass->kernels[k]);
    }
}

// ---- tests ----------------------------------------------------------------------------------

static void every_pass(void **state)
{
    (void)state;
    faults = 0;
    assert_true(tyn_num_passes() > 0);
    for (uint32_t i = 0; i < tyn_num_passes(); i++) {
        check_pass(tyn_pass_at(i));
    }
    assert_int_equal(faults, 0);
}

// Faults that the check finds in a copy of the pass whose first kernel is `kernel`.
static int faults_with(const tyn_pass_desc *pass, const tyn_kernel *kernel)
{
    tyn_pass_desc copy = *pass;
    copy.kernels = kernel;
    copy.num_kernels = 1;
    faults = 0;
    check_pass(&copy);
    return faults;
}

// The check is worth something only if it fails: one table entry after the other is made wrong.
static void drift_is_found(void **state)
{
    (void)state;
    quiet = true;
    for (uint32_t i = 0; i < tyn_num_passes(); i++) {
        const tyn_pass_desc *pass = tyn_pass_at(i);
        for (uint32_t k = 0; k < pass->num_kernels; k++) {
            tyn_kernel kernel = pass->kernels[k];
            tyn_binding bindings[TYN_MAX_BINDINGS];
            memcpy(bindings, kernel.bindings, kernel.num_bindings * sizeof *bindings);
            kernel.bindings = bindings;
            if (kernel.raster) {
                tyn_raster raster = *kernel.raster;
                raster.num_attachments--;
                raster.attachments++; // the first is missing
                kernel.raster = &raster;
                assert_true(faults_with(pass, &kernel) > 0);
                kernel.raster = NULL;
                assert_true(faults_with(pass, &kernel) > 0);
                kernel.raster = pass->kernels[k].raster;
            }
            kernel.local_size[0]++;
            assert_true(faults_with(pass, &kernel) > 0);
            kernel.local_size[0]--;
            kernel.args_size += 4;
            assert_true(faults_with(pass, &kernel) > 0);
            kernel.args_size -= 4;
            kernel.num_spec++;
            assert_true(faults_with(pass, &kernel) > 0);
            kernel.num_spec--;
            kernel.num_bindings--;
            assert_true(faults_with(pass, &kernel) > 0);
            kernel.num_bindings++;
            for (uint32_t b = 0; b < kernel.num_bindings; b++) {
                tyn_use use = bindings[b].use;
                for (tyn_use other = TYN_USE_SAMPLED; other <= TYN_USE_UNIFORM; other++) {
                    bindings[b].use = other;
                    assert_true(other == use || faults_with(pass, &kernel) > 0);
                }
                bindings[b].use = use;
            }
        }
    }
    quiet = false;
    faults = 0;
}

// lavapipe of Mesa 22.3 writes past its own tables when it compiles a kernel with an eighth uniform buffer: crashes,
// now and then, elsewhere.
static void few_uniform_buffers(void **state)
{
    (void)state;
    uint32_t most = 0;
    for (uint32_t i = 0; i < tyn_num_passes(); i++) {
        const tyn_pass_desc *pass = tyn_pass_at(i);
        for (uint32_t k = 0; k < pass->num_kernels; k++) {
            uint32_t count = 0;
            for (uint32_t b = 0; b < pass->kernels[k].num_bindings; b++) {
                count += pass->kernels[k].bindings[b].use == TYN_USE_UNIFORM;
            }
            if (count > 7) {
                fail_msg("%s: %u uniform buffers", pass->kernels[k].name, count);
            }
            most = most > count ? most : count;
        }
    }
    print_message("%u uniform buffers at most\n", most);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_pass),
                                       cmocka_unit_test(drift_is_found),
                                       cmocka_unit_test(few_uniform_buffers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
