// scene.h -- what is rendered: media, surfaces, lights, environment, cameras. Plain data, no Vulkan. Tier 1.
//
// A scene is a tree of plain structs that may be filled by hand, by `tyndall/io.h`, or changed in
// place between frames. World space is right-handed, Y up, metres (docs/scene-format.md).
#pragma once
#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { TYN_MAX_MEDIA = 16, TYN_MAX_SHAPES = 64, TYN_MAX_LIGHTS = 64 };
enum { TYN_MAX_PHASE_TABLES = 3 * TYN_MAX_MEDIA };

// A dense density grid. Values sit at voxel centres, trilinear between them, clamped to the edge
// value in the outer half voxel. `data` is x fastest, then y, z; >= 0 and finite.
typedef struct tyn_volume {
    char *name;        // for messages; may be NULL
    uint32_t size[3];  // voxels, >= 1
    float *data;       // size[0]*size[1]*size[2]; owned by the scene. NULL: the host brings an
                       // image each frame (tyn_frame.densities), and max_density is Required
    float max_density; // Required: largest value
    // Of the file: voxel index in data (centres at whole numbers) -> its own world, column-major;
    // used by shape "grid" at load.
    double index_to_world[16];
    // Of data, for change tracking: another number whenever data changes. 0: found anew for every frame from all of it.
    uint64_t hash;
} tyn_volume;

// A dense grid of colours in the box that a medium's density fills, of its own size; values sit as those of a tyn_volume.
typedef struct tyn_color_grid {
    char *name;        // for messages; may be NULL
    uint32_t size[3];  // voxels, 1 to 65536
    uint32_t channels; // Required: 3: R, G, B of each voxel; 1: grey
    // size[0]*size[1]*size[2] * channels, x fastest; >= 0, finite; owned by the scene.
    float *data;
    float max;     // Required: no value of data is larger
    uint64_t hash; // of data, as tyn_volume.hash
} tyn_color_grid;

// Radiance of a black body, linear RGB (Rec.709), W/(m^2 sr), as light of lamps is counted here: luminance in cd/m^2 over
// 683 lm/W. `kelvins` >= 0 and finite, else 0. Colours beyond Rec.709 have their negative channels set to 0.
// Planck's law over the CIE 1931 2 degree observer (fits of Wyman, Sloan and Shirley 2013).
TYN_API void tyn_blackbody(double kelvins, float rgb[3]);

// The phase function of one colour channel: how scattered light is spread over angles. {0} is isotropic.
// {.g = 0.8f} is a Henyey-Greenstein lobe; any other is made by tyn_scene_add_phase, which sets all members.
typedef struct tyn_phase {
    float g;        // mean cosine, (-1, 1)
    uint32_t table; // 1 + index into scene.phase_tables; 0: the Henyey-Greenstein lobe of g
    // Of what is in the table; else 0.
    float delta; // part of it that delta scaling counts as going straight on, [0, 1)
    // Mean cosines g of the Henyey-Greenstein lobes that are as high straight on and straight back, [0, 1).
    float forward, backward;
    uint32_t key; // another for other values
} tyn_phase;

// A phase function as values at the angles 4 atan((k / (TYN_PHASE_NODES - 1))^4), closest where lobes are narrow;
// between them it is linear in the cosine. >= 0 and finite; its integral over the sphere is 1.
enum { TYN_PHASE_NODES = 2048 };
typedef struct tyn_phase_table {
    float values[TYN_PHASE_NODES]; // 1/sr
} tyn_phase_table;

// A lobe of Draine (2003): (1 - g^2) / (4 pi s^3) (1 + alpha mu^2) / (1 + alpha (1 + 2 g^2) / 3), s^2 = 1 + g^2 - 2 g mu,
// mu the cosine of the scattering angle. alpha 0: Henyey-Greenstein; 1: Cornette and Shanks (1992), of g 0: Rayleigh.
typedef struct tyn_phase_lobe {
    float weight; // >= 0; those of a phase function add up to 1, within 1 %
    float g;      // of the Henyey-Greenstein factor, -0.999 to 0.999
    float alpha;  // >= 0
} tyn_phase_lobe;

// What a phase function is made of. One kind of arrays is given, the others are NULL.
enum { TYN_MAX_PHASE_NUMBERS = 65536, TYN_MAX_PHASE_LOBES = 16 };
typedef struct tyn_phase_form {
    uint32_t count;              // of lobes, moments, or angles with their values
    const tyn_phase_lobe *lobes; // their sum
    // Legendre moments chi_l of p = sum_l (2 l + 1) / (4 pi) chi_l P_l; chi_0 is 1, within 1 %.
    const double *moments;
    const double *angles; // radians, from 0 to pi, increasing
    // At the angles, 1/sr, linear between them; integral over the sphere 1, within 1 %.
    const double *values;
} tyn_phase_form;

// Coefficients at density 1, linear RGB.
typedef struct tyn_medium {
    char *name;
    float sigma_s[3];   // scattering, 1/m, >= 0
    float sigma_a[3];   // absorption, 1/m, >= 0
    tyn_phase phase[3]; // of each channel
    float emission[3];  // W/(m^3 sr), >= 0
    // Multiplies the density, > 0; 0 = 1. (A medium that is not to be there has coefficients 0, or no shape.)
    float density_scale;
    int32_t volume; // Required: index into scene.volumes; -1: homogeneous, density 1
    // Grids that vary the medium beyond its density: 1 + index into scene.color_grids, 0: none.
    uint32_t emission_grid; // what `emission` is multiplied with, in place of the density
    // W/(m^2 sr), of black bodies: the absorption at a point times it is emitted as well.
    uint32_t radiance_grid;
    // 0 to 1: sigma_s / (sigma_s + sigma_a), in place of the coefficients' own; their sum stays.
    uint32_t albedo_grid;
} tyn_medium;
static inline float tyn_medium_scale(const tyn_medium *medium)
{
    return medium->density_scale == 0.0f ? 1.0f : medium->density_scale;
}
// Coefficients 0, no grids of colours: it is as if it were not there.
TYN_API void tyn_medium_clear(tyn_medium *medium);

typedef enum tyn_shape_kind { TYN_SHAPE_BOX = 0, TYN_SHAPE_SPHERE = 1 } tyn_shape_kind;

// Where a medium is: the unit box [-0.5, 0.5]^3, or the sphere of radius 0.5 in it, under a matrix.
// The medium's grid fills the unit box.
typedef struct tyn_shape {
    tyn_shape_kind kind;
    uint32_t medium;
    float to_world[16]; // Required: affine, invertible, column-major
    bool repeat[3];     // periodic along local axes (box only)
} tyn_shape;

typedef enum tyn_light_kind {
    TYN_LIGHT_DIRECTIONAL = 0,
    TYN_LIGHT_POINT,
    TYN_LIGHT_SPOT
} tyn_light_kind;

typedef struct tyn_light {
    char *name;
    tyn_light_kind kind;
    float color[3]; // directional: irradiance on a perpendicular plane, W/m^2; point and spot: W/sr
    float position[3];  // world, metres (point, spot)
    float direction[3]; // Required of directional lights and spots: unit, direction of travel
    float cos_inner, cos_outer; // spot: cosines of the cone half angles, cos_inner >= cos_outer
} tyn_light;

typedef struct tyn_light_traits {
    const char *name; // in glTF
    const char *unit; // of `color`
    bool has_position, has_direction;
    bool has_cone;              // cos_inner and cos_outer are the light's own
    float cos_inner, cos_outer; // ... else these: what it shines within, -1 and -1: all around
} tyn_light_traits;
TYN_API const tyn_light_traits *tyn_light_traits_of(tyn_light_kind kind); // NULL: no such kind
// Power over `color`, sr; 0 of directional lights.
TYN_API double tyn_light_solid_angle(const tyn_light *light);

// Surfaces: one soup of triangles in world space. Diffuse (Lambertian), opaque, reflecting alike on both
// sides. The arrays below are what shaders read (`surface_*` of shaders/surfaces/surface_args.h), so they reach the
// GPU as they are.
typedef struct tyn_surface_vertex {
    float position[3]; // world, m
    float u;           // texture coordinates: (0, 0) is the outer corner of a texture's first texel
    float normal[3];   // world, unit; for shading, on the front side
    float v;
} tyn_surface_vertex;

typedef struct tyn_surface_triangle {
    uint32_t vertices[3]; // counter-clockwise as seen from the front
    uint32_t material;
} tyn_surface_triangle;

enum { TYN_SURFACE_EMITS_BOTH_SIDES = 1 };
#define TYN_NO_TEXTURE UINT32_MAX
typedef struct tyn_surface_material {
    float albedo[3];   // linear, 0 to 1; the texture multiplies it
    uint32_t flags;    // TYN_SURFACE_EMITS_BOTH_SIDES, else only the front emits
    float emission[3]; // radiance, W/(m^2 sr), >= 0
    uint32_t texture;  // Required: index into textures, or TYN_NO_TEXTURE
} tyn_surface_material;

// The numbers of a material, for what goes through all of them: checks, files, listings.
typedef struct tyn_material_field {
    const char *name;
    size_t offset;            // of its floats in a tyn_surface_material
    uint32_t count;           // of them
    float max;                // they are 0 to that
    const char *range, *unit; // "between 0 and 1", "W/(m^2 sr)"
    // In a glTF material: the object in it (NULL: itself) and the name of a factor between 0 and 1, of so many numbers.
    const char *object, *factor;
    int32_t factors;
    double factor_def;
} tyn_material_field;
enum { TYN_MATERIAL_ALBEDO = 0, TYN_MATERIAL_EMISSION, TYN_MATERIAL_NUM_FIELDS };
TYN_API extern const tyn_material_field tyn_material_fields[TYN_MATERIAL_NUM_FIELDS];

typedef enum tyn_wrap { TYN_WRAP_REPEAT = 0, TYN_WRAP_CLAMP, TYN_WRAP_MIRROR } tyn_wrap;
enum { TYN_MAX_TEXTURE_SIDE = 16384 };
typedef struct tyn_texture {
    char *name;       // for messages; may be NULL
    uint32_t size[2]; // texels, 1 to TYN_MAX_TEXTURE_SIDE
    uint8_t *texels;  // R8 G8 B8 A8, sRGB, rows in the order of v; alpha is not read
    tyn_wrap wrap[2]; // along u and v
} tyn_texture;

// A binary hierarchy over the triangles, for methods that trace rays: tyn_surfaces_build_nodes of
// <tyndall/io.h>, or any other builder. Node 0 is the root; children follow their parent.
enum { TYN_SURFACE_MAX_DEPTH = 64 }; // levels, the root's included
typedef struct tyn_surface_node {
    float lo[3];    // world, m: encloses all that is below
    uint32_t first; // inner: its children are nodes `first` and `first` + 1; leaf: first triangle
    float hi[3];
    uint32_t count; // triangles of a leaf; 0: inner
} tyn_surface_node;

typedef struct tyn_surfaces { // arrays are owned by the scene, from malloc; NULL if empty
    tyn_surface_vertex *vertices;
    uint32_t num_vertices;
    tyn_surface_triangle *triangles;
    uint32_t num_triangles;
    tyn_surface_material *materials;
    uint32_t num_materials;
    tyn_texture *textures;
    uint32_t num_textures;
    tyn_surface_node *nodes; // NULL: none
    uint32_t num_nodes;
    uint64_t hash; // changes when anything above does; 0: found anew for every frame from all of it
} tyn_surfaces;

// A latitude-longitude map, or a constant. Mapping: docs/scene-format.md.
typedef struct tyn_environment {
    bool present;
    uint32_t size[2];  // texels; {0,0}: constant
    float *data;       // RGB float triples, row 0 is up (+Y); owned by the scene
    float radiance[3]; // scales the map, or is the constant radiance, W/(m^2 sr)
    float rotation[4]; // quaternion x, y, z, w: turns the map in the world; {0,0,0,0} = identity
    float strength;    // multiplies everything, > 0; 0 = 1
    uint64_t hash;     // of data, as tyn_volume.hash
} tyn_environment;
static inline float tyn_environment_strength(const tyn_environment *env)
{
    return env->strength == 0.0f ? 1.0f : env->strength;
}

// A compact spot of a map with much of its light: methods treat it as a directional light.
enum { TYN_MAX_MAP_SUNS = 4 };
typedef struct tyn_environment_sun {
    float irradiance[3]; // across its direction, W/m^2
    float direction[3];  // of travel, world, unit
    float radius;        // of an even disc with its mean cosine, radians
} tyn_environment_sun;
// Finds them, brightest first; gives their number, 0 for a constant. Reads the whole map.
TYN_API uint32_t tyn_environment_suns(const tyn_environment *env,
                                      tyn_environment_sun suns[TYN_MAX_MAP_SUNS]);

typedef enum tyn_projection { TYN_PERSPECTIVE = 0, TYN_ORTHOGRAPHIC = 1 } tyn_projection;

typedef struct tyn_camera {
    char *name;        // node's name; may be NULL
    char *camera_name; // glTF camera's name; may be NULL
    uint32_t index;    // in the file's list of cameras, which several nodes may use
    tyn_projection projection;
    float position[3];              // world, metres
    float right[3], up[3], back[3]; // orthonormal, right-handed; looks along -back
    float yfov;   // Required: perspective: full vertical field of view, radians, (0, pi)
    float ymag;   // orthographic: half height, metres, > 0
    float aspect; // width / height as stored in the file; 0 = not given
} tyn_camera;

// What the lights of a file are given in. The library computes with the first.
typedef enum tyn_light_units {
    TYN_LIGHTS_RADIOMETRIC = 0, // W/m^2, W/sr
    TYN_LIGHTS_PHOTOMETRIC,     // lux, candela: 683 lm to the watt
} tyn_light_units;

typedef struct tyn_scene {
    char *name;
    tyn_volume *volumes;
    uint32_t num_volumes;
    tyn_color_grid *color_grids;
    uint32_t num_color_grids;
    tyn_phase_table *phase_tables; // from malloc
    uint32_t num_phase_tables;
    tyn_medium media[TYN_MAX_MEDIA];
    uint32_t num_media;
    tyn_shape shapes[TYN_MAX_SHAPES];
    uint32_t num_shapes;
    tyn_light lights[TYN_MAX_LIGHTS];
    uint32_t num_lights;
    tyn_environment environment;
    tyn_camera *cameras;
    uint32_t num_cameras;
    tyn_surfaces surfaces;
    uint32_t num_meshes;       // of the file, as many times as its nodes show them
    uint64_t clamped_negative; // negative densities that were set to 0 at load
    char **warnings;           // one line each, e.g. "mesh 'wall': its lines are left out"
    uint32_t num_warnings;
    tyn_light_units
        light_units; // that the lights were taken in, by what the file says of its generator
    char *generator; // asset.generator of a glTF file; NULL: none
} tyn_scene;

TYN_API void tyn_scene_init(tyn_scene *scene);   // an empty scene; call before filling by hand
TYN_API void tyn_scene_finish(tyn_scene *scene); // frees everything it owns, leaves an empty scene
TYN_API void tyn_scene_warn(tyn_scene *scene, const char *format, ...) TYN_PRINTF(2, 3);

// The lights as if their numbers had been in these units: divides by 683 lm/W, multiplies or does nothing.
TYN_API void tyn_scene_take_lights_as(tyn_scene *scene, tyn_light_units units);

TYN_API double tyn_phase_mean_cosine(tyn_phase phase);
// f, the part of the scattering that delta scaling counts as going straight on.
TYN_API double tyn_phase_delta_fraction(tyn_phase phase);
TYN_API bool tyn_phase_equal(tyn_phase a, tyn_phase b);

// A parameter of phase functions; inclusive range.
typedef struct tyn_phase_parameter {
    const char *name;  // of the member of tyn_phase
    const char *key;   // in a glTF file
    const char *title; // in words
    const char *right; // its range in words
    float lo, hi;
    size_t offset; // in tyn_phase
} tyn_phase_parameter;
TYN_API const tyn_phase_parameter *tyn_phase_parameters(void); // the last has no name
TYN_API void tyn_phase_get(const tyn_phase phase[3], const tyn_phase_parameter *p, float values[3]);
TYN_API void tyn_phase_set(tyn_phase phase[3], const tyn_phase_parameter *p, const float values[3]);

// Adds the table of a phase function, if the scene does not have it yet, and writes the phase function; of one
// Henyey-Greenstein lobe there is no table. It is scaled to an integral of 1. What is wrong is one log line ("media[0].phase:
// ...", after `of`) and TYN_ERR_PARAMS.
TYN_API tyn_result tyn_scene_add_phase(tyn_scene *scene, const tyn_phase_form *form, const char *of,
                                       tyn_phase *phase, const tyn_log *log);
// Water droplets of that diameter, 5 to 50 micrometres, in visible light: the fit of Jendersie and d'Eon, "An approximate
// Mie scattering function for fog and cloud rendering" (SIGGRAPH 2023 Talks). TYN_ERR_PARAMS beyond that range.
TYN_API tyn_result tyn_phase_droplets(double micrometres, tyn_phase_lobe lobes[2]);

// Checks every number of the scene; the first fault is one log line.
TYN_API tyn_result tyn_scene_check(const tyn_scene *scene, const tyn_log *log);

// Union of the world boxes of all shapes; without shapes, of the surfaces' vertices. False (and zeros) if
// there is neither.
TYN_API bool tyn_surfaces_emit(const tyn_surfaces *surfaces); // any of the triangles
TYN_API bool tyn_scene_bounds(const tyn_scene *scene, float lo[3], float hi[3]);

// The camera used when a scene has none: the bounding sphere of the media, without media of the
// surfaces, framed at 40 degrees from a little above.
TYN_API void tyn_camera_frame_scene(tyn_camera *camera, const tyn_scene *scene);

// Looks from `from` at `at`; up is +Y, -Z where the view is parallel to it.
TYN_API tyn_result tyn_camera_look_at(tyn_camera *camera, const float from[3], const float at[3]);

// Overrides of every medium (`--sigma-s`, ...). NULL fields are left. g makes phase functions Henyey-Greenstein ones;
// albedo is applied last, keeping sigma_t. density_scale <= 0 means "not given".
typedef struct tyn_medium_override {
    const float *sigma_s, *sigma_a, *g, *albedo; // 3 floats each
    float density_scale;
} tyn_medium_override;
TYN_API tyn_result tyn_scene_override(tyn_scene *scene, const tyn_medium_override *override,
                                      const tyn_log *log);

#ifdef __cplusplus
}
#endif
