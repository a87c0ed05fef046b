// diffusion.h -- pass "diffusion": fluence and flux of light that has scattered, by the diffusion approximation.
//
// With D = 1 / (3 sigma_tr), b and B the fluence and flux of light that has not scattered, j the emission and s = sigma_s' g' B
// / sigma_tr:
//     F = s - D grad phi,    div F + sigma_a phi = sigma_s' b + 4 pi j,
// and at the faces of the lattice Marshak's condition phi / 4 - F.n / 2 = pi Lbar, Lbar the radiance that comes in from all
// sides. Where phi changes much within a free path D is less, so that |F| stays below phi (Levermore and Pomraning 1981; Koerner
// et al. 2014 for such media). In finite volumes on the lattice's cells, by successive over-relaxation of cells of two colours.
#pragma once
#include <tyndall/extend/lattice_shape.h>

typedef struct diffusion_params {
    tyn_lattice_shape shape; // set by the method; shape.cells is "diffusion.cells"
    int32_t sweeps;          // "diffusion.sweeps"
} diffusion_params;

// clang-format off
#define DIFFUSION_PORTS(X) \
    X(DIFFUSION, CELLS, cells, IN, IMAGE_3D, "tyn_sources.lattice.cells"), \
    X(DIFFUSION, SOURCE, source, OPTIONAL, IMAGE_3D, "tyn_sources.lattice.source"), \
    X(DIFFUSION, ENVIRONMENT, environment, OPTIONAL, BUFFER, "struct env_block: its mean enters at the box"), \
    X(DIFFUSION, MOMENTS, moments, OUT, IMAGE_3D, "fluence and net flux, W/m^2; channels stacked along z", \
        .format = VK_FORMAT_R32G32B32A32_SFLOAT), \
    X(DIFFUSION, COUNTERS, counters, OUT, BUFFER, "struct counters_block"), \
    X(DIFFUSION, SYSTEM, system, SCRATCH, BUFFER, \
        "vec4[channel][cell]: D, sigma_a dx, what is put in over dx^2, 0"), \
    X(DIFFUSION, FORWARD, forward, SCRATCH, BUFFER, "vec4[channel][cell]: s, W/m^2"), \
    X(DIFFUSION, FLUENCE, fluence, SCRATCH, BUFFER, "float[channel][cell]: phi, W/m^2")
// clang-format on
enum { DIFFUSION_PORTS(TYN_PORT_ENUM), DIFFUSION_NUM_PORTS };
extern const tyn_pass_desc pass_diffusion;
