// bundles.h -- the bundles of ports (tyndall/pass.h): what goes together from the passes that make it to those that
// read it.
//
// A bundle's GLSL include declares its bindings in the order of its table, from the one on that the kernel defines
// (BEAMS_AT); job/refs.h has a struct of refs of each.
#pragma once

// The medium (medium.glsl). sigma_a, g and emission exist in mode COEFFICIENTS only.
#define TYN_MEDIUM(X, P)                                                                           \
    X(P, MEDIUM, medium, TYN_BUFFER, false, "struct medium_block"),                                \
        X(P, DENSITY, density, TYN_IMAGE_3D, false, "density, or sigma_s of unequal media, 1/m"),  \
        X(P, SIGMA_A, sigma_a, TYN_IMAGE_3D, true, "of unequal media, 1/m"),                       \
        X(P, G, g, TYN_IMAGE_3D, true, "mean cosine of unequal media"),                            \
        X(P, EMISSION, emission, TYN_IMAGE_3D, true, "of unequal media, W/(m^3 sr)")

// Optical depths along the suns (beam.glsl). tau_a and tau_p exist in mode COEFFICIENTS only.
#define TYN_BEAMS(X, P)                                                                            \
    X(P, BEAMS, beams, TYN_BUFFER, false, "struct beam_block[]"),                                  \
        X(P, COLUMN, column, TYN_IMAGE_3D, false,                                                  \
          "density (or sigma_s) integrated along the suns"),                                       \
        X(P, TAU_A, tau_a, TYN_IMAGE_3D, true, "sigma_a, so"),                                     \
        X(P, TAU_P, tau_p, TYN_IMAGE_3D, true, "(1 - f) sigma_s, so")

// The same from lamps and virtual point lights (radial.glsl).
#define TYN_RADIALS(X, P)                                                                          \
    X(P, RADIALS, radials, TYN_BUFFER, false, "struct radial_block"),                              \
        X(P, RADIAL_COLUMN, radial_column, TYN_IMAGE_3D, false,                                    \
          "mean density (or sigma_s) on the way from lamps"),                                      \
        X(P, RADIAL_TAU_A, radial_tau_a, TYN_IMAGE_3D, true, "mean sigma_a"),                      \
        X(P, RADIAL_TAU_P, radial_tau_p, TYN_IMAGE_3D, true, "mean (1 - f) sigma_s")

// Optical depths along the ordinates (columns.glsl).
#define TYN_COLUMNS(X, P)                                                                          \
    X(P, ORDINATES, ordinates, TYN_BUFFER, false, "struct ordinates_block"),                       \
        X(P, COLUMNS, columns, TYN_BUFFER, false, "optical depths along the ordinates")

// Shadow maps of suns and lamps (shadow.glsl).
#define TYN_SHADOWS(X, P)                                                                          \
    X(P, SHADOW_ATLAS, shadow_atlas, TYN_IMAGE_2D, false, "depth maps of the lights"),             \
        X(P, SHADOWS, shadows, TYN_BUFFER, false, "struct shadow_light[]")

// Surfaces as the lattice sees them (lattice_walls.glsl).
#define TYN_WALLS(X, P)                                                                            \
    X(P, WALL_LINKS, wall_links, TYN_BUFFER, false, "uint[cell]: where walls pass"),               \
        X(P, WALL_CELLS, wall_cells, TYN_BUFFER, false, "struct wall_cell[cell]")

// Virtual point lights (vpl_visibility.glsl).
#define TYN_VPLS(X, P)                                                                             \
    X(P, VPLS, vpls, TYN_BUFFER, false, "struct radial_vpls"),                                     \
        X(P, VPL_DISTANCES, vpl_distances, TYN_IMAGE_2D, false, "what they see, m"),               \
        X(P, VPL_PLANES, vpl_planes, TYN_IMAGE_2D, false, "and its planes")

// What the lights shine on (rsm_args.h).
#define TYN_RSM(X, P)                                                                              \
    X(P, RSM_FLUX, rsm_flux, TYN_IMAGE_2D, false, "power that a texel reflects, W"),               \
        X(P, RSM_POSITION, rsm_position, TYN_IMAGE_2D, false, "where (M, m); area of it, m^2"),    \
        X(P, RSM_NORMAL, rsm_normal, TYN_IMAGE_2D, false,                                          \
          "of the surface (M), on the light's side")

// Surfaces: where they are (surface_trace.glsl), ...
#define TYN_GEOMETRY(X, P)                                                                         \
    X(P, SURFACES, surfaces, TYN_BUFFER, false, "struct surface_block"),                           \
        X(P, VERTICES, vertices, TYN_BUFFER, false, "struct surface_vertex[]"),                    \
        X(P, TRIANGLES, triangles, TYN_BUFFER, false, "struct surface_triangle[]"),                \
        X(P, NODES, nodes, TYN_BUFFER, true, "struct surface_node[]: their hierarchy")
// ... and what they are of (surface_texture.glsl).
#define TYN_MATERIALS(X, P)                                                                        \
    X(P, MATERIALS, materials, TYN_BUFFER, false, "struct surface_material[]"),                    \
        X(P, TEXTURES, textures, TYN_BUFFER, true, "struct surface_texture[]"),                    \
        X(P, TEXELS, texels, TYN_BUFFER, true, "uint[]: R8 G8 B8 A8, sRGB")

// What the path tracer reads beside surfaces.
#define TYN_PATH_SCENE(X, P)                                                                       \
    X(P, ATLAS, atlas, TYN_IMAGE_3D, true, "all density grids"),                                   \
        X(P, MEDIUM, medium, TYN_BUFFER, false, "struct medium_block: box and bricks"),            \
        X(P, SHAPES, shapes, TYN_BUFFER, true, "struct shape_block[]: the exact media"),           \
        X(P, BRICKS, bricks, TYN_IMAGE_3D, true,                                                   \
          "least and largest density or extinction of bricks"),                                    \
        X(P, LIGHTS, lights, TYN_BUFFER, true, "struct light_block[]: suns and lamps"),            \
        X(P, ENVIRONMENT, environment, TYN_BUFFER, true, "struct env_block"),                      \
        X(P, ENV_MAP, env_map, TYN_IMAGE_2D, true, "radiance, W/(m^2 sr)"),                        \
        X(P, ENV_TABLE, env_table, TYN_BUFFER, true,                                               \
          "struct env_table_block and cells: alias table of the map's brightness"),                \
        X(P, EMITTERS, emitters, TYN_BUFFER, true,                                                 \
          "struct surface_table and cells: alias table of the emissive triangles' power")
