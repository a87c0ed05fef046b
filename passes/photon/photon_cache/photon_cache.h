// photon_cache.h -- the sum of the generations of photons that count, cell by cell.
#pragma once
#include <tyndall/pass.h>
#include <tyndall/extend/lattice_shape.h>

typedef struct tyn_photon_cache_params {
    tyn_lattice_shape shape;
    uint32_t generations, slots; // that count, and of the ring
    uint32_t lobes;              // of a cell
    float unit;                  // W m of a unit
    float majorant;  // > 0: light is weighted with the extinction over this, 1/m; 0: with volume
    uint32_t scaled; // 1: forward scattering counts as none
} tyn_photon_cache_params;

// clang-format off
#define PHOTON_CACHE_PORTS(X) \
    X(PHOTON_CACHE, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(PHOTON_CACHE, CELLS, cells, IN, IMAGE_3D, "of lattice_cells: the medium in the cells"), \
    X(PHOTON_CACHE, RING, ring, IN, BUFFER, "of photon_trace"), \
    X(PHOTON_CACHE, FLUX, flux, IN, BUFFER, "of photon_trace"), \
    X(PHOTON_CACHE, SUM, sum, INOUT, BUFFER, "tyn_photon_sum_size bytes: a history"), \
    X(PHOTON_CACHE, LIGHT, light, OUT, BUFFER, "struct photon_light[lobe][cell]"), \
    X(PHOTON_CACHE, MOMENTS, moments, OUT, RGBA_3D, "fluence and net flux, W/m^2, channels stacked along z"), \
    X(PHOTON_CACHE, COUNTERS, counters, OUT, BUFFER, "struct counters_block: cells that were bounded")
// clang-format on
TYN_PASS(PHOTON_CACHE, photon_cache);
