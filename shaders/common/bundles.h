// bundles.h -- the bundles of ports (tyndall/pass.h): what goes together from the passes that make it to those that
// read it.
//
// A bundle's GLSL include declares its bindings in the order of its table, from the one on that the kernel defines
// (BEAMS_AT); tyndall/extend/refs.h has a struct of refs of each.
#pragma once

// clang-format off

// The medium (medium.glsl). sigma_a and emission exist of unequal media alone (all modes but DENSITY), g in mode COEFFICIENTS.
#define TYN_MEDIUM(X, P) \
    X(P, MEDIUM, medium, IN, BUFFER, "struct medium_block"), \
    X(P, DENSITY, density, IN, IMAGE_3D, "density, or sigma_s of unequal media, 1/m"), \
    X(P, SIGMA_A, sigma_a, OPTIONAL, IMAGE_3D, "of unequal media, 1/m"), \
    X(P, G, g, OPTIONAL, IMAGE_3D, "mean cosine, where phase functions differ"), \
    X(P, EMISSION, emission, OPTIONAL, IMAGE_3D, "of unequal media, W/(m^3 sr)")

// Optical depths along the suns (beam.glsl). tau_a and tau_p exist of unequal media alone.
#define TYN_BEAMS(X, P) \
    X(P, BEAMS, beams, IN, BUFFER, "struct beam_block[]"), \
    X(P, COLUMN, column, IN, IMAGE_3D, "density (or sigma_s) integrated along the suns"), \
    X(P, TAU_A, tau_a, OPTIONAL, IMAGE_3D, "sigma_a integrated along the suns"), \
    X(P, TAU_P, tau_p, OPTIONAL, IMAGE_3D, "(1 - f) sigma_s integrated along the suns")

// The same from lamps and virtual point lights (radial.glsl).
#define TYN_RADIALS(X, P) \
    X(P, RADIALS, radials, IN, BUFFER, "struct radial_block"), \
    X(P, RADIAL_COLUMN, radial_column, IN, IMAGE_3D, "mean density (or sigma_s) on the way from lamps"), \
    X(P, RADIAL_TAU_A, radial_tau_a, OPTIONAL, IMAGE_3D, "mean sigma_a"), \
    X(P, RADIAL_TAU_P, radial_tau_p, OPTIONAL, IMAGE_3D, "mean (1 - f) sigma_s")

// Optical depths along the ordinates (columns.glsl).
#define TYN_COLUMNS(X, P) \
    X(P, ORDINATES, ordinates, IN, BUFFER, "struct ordinates_block"), \
    X(P, COLUMNS, columns, IN, BUFFER, "optical depths along the ordinates")

// Shadow maps of suns and lamps (shadow.glsl).
#define TYN_SHADOWS(X, P) \
    X(P, SHADOW_ATLAS, shadow_atlas, IN, IMAGE_2D, "depth maps of the lights"), \
    X(P, SHADOWS, shadows, IN, BUFFER, "struct shadow_light[]")

// Depth maps of the directions of the sky (sky_maps.glsl).
#define TYN_SKY_MAPS(X, P) \
    X(P, SKY_ATLAS, sky_atlas, IN, IMAGE_2D, "depth maps of the directions of the sky"), \
    X(P, SKY_MAPS, sky_maps, IN, BUFFER, "struct shadow_light[]: of each direction")

// What surfaces leave of the ordinates in the lattice's cells (sky_seen.glsl), and of the sky's mean.
#define TYN_SKY_SEEN(X, P) \
    X(P, SKY_SEEN, sky_seen, IN, BUFFER, "share of the ordinates' light that passes the surfaces"), \
    X(P, ENVIRONMENT, environment, IN, BUFFER, "struct env_block")

// Surfaces as the lattice sees them (lattice_walls.glsl).
#define TYN_WALLS(X, P) \
    X(P, WALL_LINKS, wall_links, IN, BUFFER, "uint[cell]: which of its 26 links are cut"), \
    X(P, WALL_CELLS, wall_cells, IN, BUFFER, "struct wall_cell[cell]: mean albedo and planes of a cell's walls")

// Virtual point lights (vpl_visibility.glsl).
#define TYN_VPLS(X, P) \
    X(P, VPLS, vpls, IN, BUFFER, "struct radial_vpls"), \
    X(P, VPL_DISTANCES, vpl_distances, IN, IMAGE_2D, "what they see, m"), \
    X(P, VPL_PLANES, vpl_planes, IN, IMAGE_2D, "planes of the surfaces that they see")

// What the lights shine on (rsm_args.h).
#define TYN_RSM(X, P) \
    X(P, RSM_FLUX, rsm_flux, IN, RGBA_2D, "power that a texel reflects, W"), \
    X(P, RSM_POSITION, rsm_position, IN, RGBA_2D, "where (M, m); area of it, m^2"), \
    X(P, RSM_NORMAL, rsm_normal, IN, RGBA_2D, "of the surface (M), on the light's side")

// What the camera sees of the surfaces (gbuffer.glsl).
#define TYN_GBUFFER(X, P) \
    X(P, SEEN, seen, IN, IMAGE_2D, "gbuffer.glsl: the triangle that each sample sees", .format = VK_FORMAT_R32_UINT)

// Surfaces: where they are (surface_trace.glsl), ...
#define TYN_GEOMETRY(X, P) \
    X(P, SURFACES, surfaces, IN, BUFFER, "struct surface_block"), \
    X(P, VERTICES, vertices, IN, BUFFER, "struct surface_vertex[]"), \
    X(P, TRIANGLES, triangles, IN, BUFFER, "struct surface_triangle[]"), \
    X(P, NODES, nodes, OPTIONAL, BUFFER, "struct surface_node[]: their hierarchy")
// ... and what they are of (reflectance.glsl, surface_texture.glsl).
#define TYN_MATERIALS(X, P) \
    X(P, MATERIALS, materials, IN, BUFFER, "struct surface_material[]"), \
    X(P, TEXTURES, textures, OPTIONAL, BUFFER, "struct surface_texture[]"), \
    X(P, TEXELS, texels, OPTIONAL, BUFFER, "uint[]: R8 G8 B8 A8, sRGB")

// What the path tracer reads. Without nodes all triangles are tried.
#define TYN_PATH_SCENE(X, P) \
    X(P, ATLAS, atlas, OPTIONAL, IMAGE_3D, "all density grids"), \
    X(P, MEDIUM, medium, IN, BUFFER, "struct medium_block: box and bricks"), \
    X(P, SHAPES, shapes, OPTIONAL, BUFFER, "struct shape_block[]: the exact media"), \
    X(P, BRICKS, bricks, OPTIONAL, IMAGE_3D, "least and largest density or extinction of bricks"), \
    X(P, LIGHTS, lights, OPTIONAL, BUFFER, "struct light_block[]: suns and lamps"), \
    X(P, ENVIRONMENT, environment, OPTIONAL, BUFFER, "struct env_block"), \
    X(P, ENV_MAP, env_map, OPTIONAL, IMAGE_2D, "radiance, W/(m^2 sr)"), \
    X(P, ENV_TABLE, env_table, OPTIONAL, BUFFER, \
        "struct env_table_block and cells: alias table of the map's brightness"), \
    X(P, EMITTERS, emitters, OPTIONAL, BUFFER, \
        "struct surface_table and cells: alias table of the emissive triangles' power"), \
    X(P, COLORS, colors, OPTIONAL, IMAGE_3D, "grids of colours of all media"), \
    X(P, PHASES, phases, OPTIONAL, BUFFER, "tables of phase functions (phase_table.glsl)"), \
    TYN_GEOMETRY(X##_OPTIONAL, P), \
    TYN_MATERIALS(X##_OPTIONAL, P)
// clang-format on
