// shade.c -- see shade.h.
#include "shade.h"
#include "shade_args.h"
#include "passes/shade_tables.h"
#include "shade_faces.h"
#include "shaders/common/counters.h"
#include "shaders/surfaces/gbuffer_edge_args.h"
#include <stddef.h>
#include <string.h>

#define PORT(name) SHADE_PORT_##name
#define TEXELS TYN_IMAGE_2D, VK_FORMAT_R32G32B32A32_UINT // shade_part.glsl

#define ARGS sizeof(struct shade_args)

static const tyn_param params[] = {
    {"pattern", TYN_PARAM_INT, offsetof(tyn_shade_params, pattern), 0, 0, 8, "pixels",
     "along each side of the pattern whose pixels share the virtual lights; 1 = every pixel takes "
     "all; 0 = 5, in small pictures 4"},
    {"step", TYN_PARAM_INT, offsetof(tyn_shade_params, step), 0, 0, 4, "pixels",
     "along each side of a block that has one place where light of virtual lights and of the "
     "lattice "
     "is taken; 0 = 2, in small pictures 1"},
};

// Of the picture, or of that of which it is a part, pixels.
static const uint32_t *whole_of(const tyn_shade_params *p)
{
    return p->whole[0] ? p->whole : p->size;
}

// Pixels along each side of a block that has one place for smooth light.
static uint32_t step_of(const tyn_shade_params *p, bool smooth)
{
    const uint32_t *whole = whole_of(p), shorter = whole[0] < whole[1] ? whole[0] : whole[1];
    return !smooth ? 1 : p->step ? (uint32_t)p->step : shorter < SHADE_STEP_FROM ? 1 : SHADE_STEP;
}

static tyn_extent blocks_of(const uint32_t pixels[2], uint32_t step)
{
    return (tyn_extent){(pixels[0] + step - 1) / step, (pixels[1] + step - 1) / step, 1};
}

static tyn_result declare(tyn_builder *b, const void *data)
{
    const tyn_shade_params *p = data;
    const bool vpls = tyn_build_has(b, PORT(VPLS)) || tyn_build_has(b, PORT(SKY_MAPS));
    const uint32_t step = step_of(p, vpls || tyn_build_has(b, PORT(MOMENTS)));
    const tyn_extent blocks = vpls || step > 1 ? blocks_of(p->size, step) : (tyn_extent){1, 1, 1};
    const bool outside = p->outside && tyn_build_has(b, PORT(MOMENTS));
    const tyn_extent faces = {SHADE_FACE_WIDTH, 6 + SHADE_FACE_SIDE, 1};
    tyn_build_image(b, PORT(SURFACE_RADIANCE), (tyn_extent){p->size[0], p->size[1], 1}, 1);
    // The moments have a cell's channels behind each other along z.
    tyn_extent cells = tyn_build_extent(b, PORT(MOMENTS));
    const uint32_t slices = cells.z / (p->one_channel ? 1 : 3);
    const tyn_extent texel = {1, 1, 1};
    const bool spread = tyn_build_has(b, PORT(WALL_LINKS)) && tyn_build_has(b, PORT(BEAMS)) &&
                        tyn_build_has(b, PORT(SHADOWS)) && p->num_suns;
    cells.z = slices * p->num_suns;
    tyn_build_image(b, PORT(FORWARD), spread ? cells : texel, 1);
    tyn_build_image(b, PORT(FACES), outside ? faces : texel, 1);
    const uint32_t *places = p->sight_places;
    const tyn_extent fields = {places[0], places[1], places[2] * SHADE_SIGHT_FIELDS};
    tyn_build_image(b, PORT(SIGHT), outside && p->hidden ? fields : texel, 1);
    tyn_build_image(b, PORT(PART), vpls ? blocks : texel, 1);
    tyn_build_image(b, PORT(PART_ROWS), blocks, 1);
    const uint64_t pixels = (uint64_t)p->size[0] * p->size[1];
    tyn_build_buffer(b, PORT(EDGE_COUNT), sizeof(struct gbuffer_edge_count));
    tyn_build_buffer(b, PORT(EDGES), 4 * (p->samples > 1 ? pixels : 1));
    const bool alone = vpls || step > 1;
    tyn_build_buffer(b, PORT(ALONE_COUNT), sizeof(struct gbuffer_edge_count));
    tyn_build_buffer(b, PORT(ALONE), 8 * (alone ? pixels : 1));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *data)
{
    const tyn_shade_params *p = data;
    const bool sky_maps = tyn_rec_has(r, PORT(SKY_MAPS));
    const bool vpls = tyn_rec_has(r, PORT(VPLS)), shared = vpls || sky_maps;
    struct shade_args args = {
        .num_directional = p->num_directional,
        .num_lamps = p->num_lamps,
        .tint = {p->tint[0], p->tint[1], p->tint[2]},
        .sight_lo = {p->sight_lo[0], p->sight_lo[1], p->sight_lo[2]},
        .sight_edge = p->sight_edge,
        .sky_fan = p->sky_fan,
        .sky_cells = {p->sky_cells[0], p->sky_cells[1], p->sky_cells[2]},
    };
    uint32_t features = 0;
    features |= tyn_rec_has(r, PORT(BEAMS)) || tyn_rec_has(r, PORT(RADIALS)) ? SHADE_MEDIUM : 0;
    features |= tyn_rec_has(r, PORT(SHADOWS)) ? SHADE_SHADOWS : 0;
    features |= vpls ? SHADE_VPLS : 0;
    features |= tyn_rec_has(r, PORT(WALL_LINKS)) ? SHADE_LATTICE : 0;
    features |= p->outside && tyn_rec_has(r, PORT(MOMENTS)) ? SHADE_OUTSIDE : 0;
    features |= p->one_channel ? SHADE_ONE_CHANNEL : 0;
    const tyn_extent forward = tyn_rec_extent(r, PORT(FORWARD));
    features |= forward.x > 1 ? SHADE_SPREAD : 0;
    features |= p->sky ? SHADE_SKY : 0;
    features |= sky_maps ? SHADE_SKY_MAPS : 0;
    features |= sky_maps && tyn_rec_has(r, PORT(COLUMNS)) && p->sky_cells[0] ? SHADE_COLUMNS : 0;
    features |= p->num_lamps ? SHADE_LAMPS : 0;
    features |= p->textured ? SHADE_TEXTURED : 0;
    features |= p->parted ? 0 : SHADE_SLICED;
    const uint32_t rooms = tyn_rec_has(r, PORT(ROOMS));
    features |= vpls && rooms && tyn_rec_has(r, PORT(WALL_LINKS)) ? SHADE_ROOMS : 0;
    const uint32_t step = step_of(p, shared || tyn_rec_has(r, PORT(MOMENTS)));
    const tyn_extent blocks = blocks_of(p->size, step), of_whole = blocks_of(whole_of(p), step);
    const uint32_t shorter = of_whole.x < of_whole.y ? of_whole.x : of_whole.y;
    const uint32_t usual = shorter < SHADE_SMALL ? SHADE_SIDE_SMALL : SHADE_SIDE;
    const uint32_t side = p->pattern ? (uint32_t)p->pattern : usual;
    uint32_t spec[6] = {p->mode, features, p->num_suns, side, step, p->samples};
    const tyn_extent pixels = {p->size[0], p->size[1], 1};
    tyn_dispatch d = {.args = &args, .spec = spec};
    if (features & SHADE_SPREAD) {
        tyn_extent cells = {forward.x, forward.y, forward.z / p->num_suns};
        TYN_DISPATCH(r, .kernel = KERNEL_FORWARD, .cells = cells, .spec = spec);
    }
    if (features & SHADE_OUTSIDE) {
        d.kernel = KERNEL_FACES;
        d.cells = (tyn_extent){6 * SHADE_FACE_PATCHES, 1, 1};
        tyn_rec_dispatch(r, &d);
        const uint32_t channels = p->one_channel ? 1 : 3;
        if (p->hidden) {
            d.kernel = KERNEL_SIGHT;
            d.cells = tyn_rec_extent(r, PORT(SIGHT));
            d.cells.z /= SHADE_SIGHT_FIELDS;
            d.spec = &channels;
            tyn_rec_dispatch(r, &d);
            d.spec = spec;
        }
    }
    if (shared) {
        tyn_rec_fill(r, PORT(ALONE_COUNT), 0);
        d.kernel = KERNEL_VPLS;
        d.cells =
            (tyn_extent){(blocks.x + side - 1) / side,
                         (blocks.y + side * SHADE_MANY - 1) / (side * SHADE_MANY), side * side};
        tyn_rec_dispatch(r, &d);
        const uint32_t of_rows[3] = {side, step, sky_maps};
        TYN_DISPATCH(r, .kernel = KERNEL_ROWS, .cells = blocks, .spec = of_rows);
        d.kernel = KERNEL_GATHER;
        d.cells = blocks;
        tyn_rec_dispatch(r, &d);
        d.kernel = KERNEL_VPLS;
        args.listed = 1;
        tyn_rec_dispatch_indirect(r, &d, PORT(ALONE_COUNT), 0);
        args.listed = 0;
    }
    if (step > 1) {
        d.kernel = KERNEL_SMOOTH;
        d.cells = blocks;
        tyn_rec_dispatch(r, &d);
    }
    tyn_rec_fill(r, PORT(ALONE_COUNT), 0);
    tyn_rec_fill(r, PORT(EDGE_COUNT), 0);
    // Surfaces look up light of VPLs, or all smooth light.
    const uint8_t looked_up[1][2] = {{PORT(PART), step > 1 ? PORT(PART_ROWS) : PORT(PART)}};
    uint8_t bound[2][TYN_MAX_BINDINGS];
    const uint32_t both = SHADE_PIXELS | SHADE_EDGES;
    d.kernel = KERNEL_SURFACE;
    d.cells = pixels;
    d.ports = tyn_ports_exchanged(&kernels[KERNEL_SURFACE], looked_up, 1, bound[0]);
    spec[1] = features | (p->parted || p->samples == 1 ? SHADE_PIXELS : both);
    tyn_rec_dispatch(r, &d);
    if (p->samples > 1) {
        spec[1] = features | (p->parted ? SHADE_EDGES : both);
        args.listed = 1;
        tyn_rec_dispatch_indirect(r, &d, PORT(EDGE_COUNT), 0);
    }
    spec[1] = features;
    if (shared || step > 1) {
        d.kernel = KERNEL_ALONE;
        d.ports = tyn_ports_exchanged(&kernels[KERNEL_ALONE], looked_up, 1, bound[1]);
        tyn_rec_dispatch_indirect(r, &d, PORT(ALONE_COUNT), 0);
    }
    tyn_rec_work(r, "pixels", (double)pixels.x * pixels.y);
}

const tyn_pass_desc tyn_pass_shade = {
    .name = "shade",
    .summary = "radiance of the surfaces that the camera sees",
    .serves = "pictures of surfaces",
    TYN_PASS_TABLES(tyn_shade_params),
    .of_pixels = true,
    TYN_SETTINGS(params),
    .debug_port = PORT(SURFACE_RADIANCE),
    .debug_meaning = "radiance of the surfaces, without the medium in front of them",
    TYN_COUNTS(PORT(COUNTERS), struct counters_block,
               {"clamped", offsetof(struct counters_block, clamped)},
               TYN_COUNTER_HIDDEN(
                   "of the lattice's light on surfaces",
                   "accuracy: light of the lattice on surfaces would be negative and is set to "
                   "0: %g %% of that light")),
};
