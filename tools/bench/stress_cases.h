// stress_cases.h -- the cases of the stress suite and their scenes.
#pragma once
#include <tyndall/context.h>

typedef enum stress_pattern {
    STRESS_HOMOGENEOUS, // no grid
    STRESS_CONSTANT,    // a grid of equal values: the same medium
    STRESS_WAVES,       // smooth, 0.2 to 1.8
    STRESS_CHECKERS,    // 1 and `contrast`, blocks of 4 voxels
    STRESS_VOXEL,       // one voxel of 1 in `contrast`
    STRESS_HALF,        // 1 below, `contrast` above
    STRESS_DECADES,     // `contrast`^(0 to 1), evenly random
    STRESS_SHELL,       // a hollow ball, two voxels thick
    STRESS_TWO_MEDIA,   // a second box that overlaps: coefficient textures
} stress_pattern;

typedef enum stress_light {
    STRESS_SUN,    // oblique, irradiance 1
    STRESS_AROUND, // radiance 1 from everywhere
    STRESS_LAMP,   // in front of the lit corner
} stress_light;

// Against what.
typedef enum stress_answer {
    STRESS_BY_PATH,      // `path` on the same light field, or on that of `like`
    STRESS_BY_FURNACE,   // 1 everywhere
    STRESS_BY_TABLE,     // half-space of isotropic scatterers: H functions
    STRESS_BY_IMBALANCE, // of the method's own balance
} stress_answer;

typedef struct stress_case {
    const char *axis, *name; // name: made of x where NULL
    double x;
    float sigma, albedo, g; // extinction at density 1, 1/m
    stress_pattern pattern;
    uint32_t size[3]; // voxels
    float contrast;
    float sides[3];      // m; 0: 1
    float offset;        // of the box from the origin, m
    float unit;          // values of the grid are in units of it; 0: 1
    const char *storage; // "medium.storage"; NULL: default
    bool coloured;       // extinction sigma / 1000, sigma, 1000 sigma
    stress_light light;
    stress_answer answer;
    // The same light field as another scene: by scaling, or because a grid is constant. Its picture is
    // the reference then, for `path` as well.
    const struct stress_case *like;
    bool quick; // part of the short run
} stress_case;

extern const stress_case stress_cases[];
extern const uint32_t stress_num_cases;

// Fills a scene and the view on it (camera and size). False: out of memory.
bool stress_scene(const stress_case *c, tyn_scene *scene);
void stress_view(const stress_case *c, tyn_view *view);

enum { STRESS_SIZE = 32, STRESS_BLOCK = 8 }; // pixels; errors are of blocks

// Radiance that leaves a half-space of isotropic scatterers, for a beam of irradiance 1 across its
// direction; mu and mu0 are cosines to the normal (Chandrasekhar 1960, section 33).
double stress_half_space(double albedo, double mu, double mu0);
// Direction of the sun, and cosine to the normal of the upper face.
extern const float stress_sun[3];
