// frame_scene.c -- turns a scene and a view into the blocks that shaders read.
#include "frame/frame_scene.h"
#include "base/fault.h"
#include "scene/matrix.h"
#include "scene/phase.h"
#include "shaders/light/shadow_args.h"
#include "shaders/surfaces/surface_table_args.h"
#include <math.h>
#include <string.h>

// Texels along the longest side of a medium that must be resampled, at most and at least.
enum { RESAMPLED_MAX = 192, RESAMPLED_HOMOGENEOUS = 96 };

// ---- small linear algebra, in double ----------------------------------------------------------

// A rigid frame: axes of M in the world, and its origin.
typedef struct rigid {
    double axes[3][3], origin[3];
} rigid;

static void to_m_direction(const rigid *m, const float world[3], float out[3])
{
    const double w[3] = {world[0], world[1], world[2]};
    for (int a = 0; a < 3; a++) {
        out[a] = (float)vec_dot(m->axes[a], w);
    }
}

static void to_m_position(const rigid *m, const float world[3], float out[3])
{
    const double w[3] = {world[0] - m->origin[0], world[1] - m->origin[1], world[2] - m->origin[2]};
    for (int a = 0; a < 3; a++) {
        out[a] = (float)vec_dot(m->axes[a], w);
    }
}

// ---- the medium frame -------------------------------------------------------------------------

static void columns(const float matrix[16], double c[4][3])
{
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 3; j++) {
            c[i][j] = matrix[i * 4 + j];
        }
    }
}

// One box or sphere without shear: M is turned with it. Gives false for shears.
static bool frame_of_shape(const tyn_shape *shape, rigid *m, double extent[3], bool *mirrored)
{
    double c[4][3], turned[3];
    columns(shape->to_world, c);
    for (int a = 0; a < 3; a++) {
        extent[a] = vec_length(c[a]);
        for (int b = 0; b < a; b++) {
            if (fabs(vec_dot(c[a], c[b])) > 1e-5 * extent[a] * extent[b]) {
                return false;
            }
        }
    }
    for (int a = 0; a < 3; a++) {
        for (int j = 0; j < 3; j++) {
            m->axes[a][j] = c[a][j] / extent[a];
        }
    }
    vec_cross(turned, m->axes[1], m->axes[2]);
    *mirrored = vec_dot(turned, m->axes[0]) < 0;
    if (*mirrored) {
        for (int j = 0; j < 3; j++) {
            m->axes[0][j] = -m->axes[0][j];
        }
    }
    for (int j = 0; j < 3; j++) {
        m->origin[j] = c[3][j];
        for (int a = 0; a < 3; a++) {
            m->origin[j] -= 0.5 * extent[a] * m->axes[a][j];
        }
    }
    return true;
}

// Axes of the world, around all media, or around the surfaces if there is no medium: then no side of the
// box is less than a thousandth of the longest, so that one wall alone spans a frame too.
static void frame_of_world(const tyn_scene *scene, const tyn_surface_data *surfaces, rigid *m,
                           double extent[3])
{
    float lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1};
    if (scene->num_shapes) {
        tyn_scene_bounds(scene, lo, hi);
    } else if (surfaces->hash) {
        float longest = 1e-6f;
        for (int a = 0; a < 3; a++) {
            longest = fmaxf(longest, surfaces->hi[a] - surfaces->lo[a]);
        }
        for (int a = 0; a < 3; a++) {
            lo[a] = surfaces->lo[a];
            hi[a] = fmaxf(surfaces->hi[a], lo[a] + 1e-3f * longest);
        }
    }
    for (int a = 0; a < 3; a++) {
        m->origin[a] = lo[a];
        extent[a] = (double)hi[a] - lo[a];
        for (int j = 0; j < 3; j++) {
            m->axes[a][j] = a == j;
        }
    }
}

static bool equal_coefficients(const tyn_medium *a, const tyn_medium *b)
{
    bool equal = true;
    for (int c = 0; c < 3; c++) {
        equal &= a->sigma_s[c] * tyn_medium_scale(a) == b->sigma_s[c] * tyn_medium_scale(b) &&
                 a->sigma_a[c] * tyn_medium_scale(a) == b->sigma_a[c] * tyn_medium_scale(b) &&
                 a->emission[c] * tyn_medium_scale(a) == b->emission[c] * tyn_medium_scale(b);
    }
    return equal;
}

static bool has_colors(const tyn_medium *m)
{
    return m->emission_grid || m->radiance_grid || m->albedo_grid;
}

// Does a medium scatter light of a channel?
static bool scatters(const tyn_scene *scene, const tyn_medium *m, int channel)
{
    const bool hollow = m->volume >= 0 && scene->volumes[m->volume].max_density <= 0;
    float strength = m->sigma_s[channel];
    if (m->albedo_grid) {
        const bool black = !tyn_colors_place(scene, m->albedo_grid).size[0];
        strength = black ? 0 : strength + m->sigma_a[channel];
    }
    return !hollow && strength * tyn_medium_scale(m) > 0;
}

// Do all media that scatter light of a channel share one phase function? `out` tells it.
static bool have_one_phase(const tyn_scene *scene, tyn_phase out[3])
{
    bool one = true;
    for (int c = 0; c < 3; c++) {
        const tyn_phase *first = NULL;
        for (uint32_t i = 0; i < scene->num_shapes; i++) {
            const tyn_medium *m = &scene->media[scene->shapes[i].medium];
            if (scatters(scene, m, c)) {
                one = one && (!first || tyn_phase_equal(*first, m->phase[c]));
                first = &m->phase[c];
            }
        }
        out[c] = first ? *first : scene->media[scene->shapes[0].medium].phase[c];
    }
    return one;
}

// Texels of a resampled medium: as fine as its finest grid, within bounds.
static void choose_size(const tyn_scene *scene, const double extent[3], uint32_t size[3])
{
    double longest = fmax(extent[0], fmax(extent[1], extent[2]));
    double h = longest / RESAMPLED_HOMOGENEOUS;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        int32_t volume = scene->media[scene->shapes[i].medium].volume;
        double c[4][3];
        columns(scene->shapes[i].to_world, c);
        for (int a = 0; volume >= 0 && a < 3; a++) {
            h = fmin(h, vec_length(c[a]) / scene->volumes[volume].size[a]);
        }
        const tyn_medium *m = &scene->media[scene->shapes[i].medium];
        const uint32_t slots[] = {m->emission_grid, m->radiance_grid, m->albedo_grid};
        for (int k = 0; k < 9; k++) {
            const uint32_t slot = slots[k / 3];
            h = slot ? fmin(h, vec_length(c[k % 3]) / scene->color_grids[slot - 1].size[k % 3]) : h;
        }
    }
    h = fmax(h, longest / RESAMPLED_MAX);
    for (int a = 0; a < 3; a++) {
        size[a] = (uint32_t)fmax(1.0, ceil(extent[a] / h - 1e-6));
    }
}

static void build_medium(tyn_frame_scene *out, const tyn_scene *scene, const double extent[3])
{
    struct medium_block *b = &out->medium;
    const tyn_medium *first = &scene->media[scene->shapes[0].medium];
    tyn_phase phase[3];
    const bool one_phase = have_one_phase(scene, phase);
    bool equal = one_phase;
    float max_sum = 0;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_medium *m = &scene->media[scene->shapes[i].medium];
        equal &= equal_coefficients(first, m) && !has_colors(m);
        max_sum += m->volume < 0 ? 1.0f : scene->volumes[m->volume].max_density;
    }
    b->mode = equal       ? TYN_MEDIUM_DENSITY
              : one_phase ? TYN_MEDIUM_ONE_PHASE
                          : TYN_MEDIUM_COEFFICIENTS;
    if (one_phase) {
        memcpy(b->phase, phase, sizeof phase);
    }
    b->num_shapes = scene->num_shapes;
    b->max_density = equal ? max_sum : 1.0f;
    b->sigma_t_max = equal ? 0.0f : 1.0f;
    for (int c = 0; equal && c < 3; c++) {
        b->sigma_s[c] = first->sigma_s[c] * tyn_medium_scale(first);
        b->sigma_a[c] = first->sigma_a[c] * tyn_medium_scale(first);
        b->emission[c] = first->emission[c] * tyn_medium_scale(first);
        b->sigma_t_max = fmaxf(b->sigma_t_max, b->sigma_s[c] + b->sigma_a[c]);
    }
    out->grey =
        equal && vec_grey(b->sigma_s) && vec_grey(b->sigma_a) && tyn_phase_is_grey(b->phase);
    if (out->direct && first->volume >= 0) {
        memcpy(b->size, scene->volumes[first->volume].size, sizeof b->size);
    } else if (out->direct) {
        b->size[0] = b->size[1] = b->size[2] = 1;
    } else {
        choose_size(scene, extent, b->size);
    }
    for (int a = 0; a < 3; a++) {
        b->extent[a] = (float)extent[a];
        b->voxel[a] = b->extent[a] / (float)b->size[a];
        b->bricks[a] = (b->size[a] + TYN_BRICK - 1) / TYN_BRICK;
        b->brick_size[a] = b->voxel[a] * TYN_BRICK;
        b->repeat[a] = scene->num_shapes == 1 && scene->shapes[0].repeat[a];
    }
}

// No medium: the box is there (around the surfaces), with one texel of nothing in it.
static void build_void(tyn_frame_scene *out, const double extent[3])
{
    struct medium_block *b = &out->medium;
    b->mode = TYN_MEDIUM_DENSITY;
    for (int a = 0; a < 3; a++) {
        b->size[a] = b->bricks[a] = 1;
        b->extent[a] = b->voxel[a] = (float)extent[a];
        b->brick_size[a] = b->voxel[a] * TYN_BRICK;
    }
}

// Rows of M -> local: the inverse of (world -> M) o (local -> world).
static void local_from_m(const tyn_shape *shape, const rigid *m, tyn_vec4 rows[3])
{
    double c[4][3], in_m[4][3];
    columns(shape->to_world, c);
    for (int j = 0; j < 3; j++) {
        c[3][j] -= m->origin[j];
    }
    for (int i = 0; i < 4; i++) {
        for (int a = 0; a < 3; a++) {
            in_m[i][a] = vec_dot(m->axes[a], c[i]);
        }
    }
    double inverse[3][3]; // times the determinant
    const double det = mat_cofactors(inverse, in_m[0], in_m[1], in_m[2]);
    for (int r = 0; r < 3; r++) {
        for (int a = 0; a < 3; a++) {
            rows[r][a] = (float)(inverse[r][a] / det);
        }
        rows[r][3] = (float)(-vec_dot(inverse[r], in_m[3]) / det);
    }
}

// Grids of colours, those that bring something; `lit`: whether they emit.
static bool build_colors(struct shape_block *b, const tyn_scene *scene, const tyn_medium *medium)
{
    float sigma_a = 0, emission = 0;
    b->colors[TYN_COLORS_ALBEDO] = tyn_colors_place(scene, medium->albedo_grid);
    const bool albedo = b->colors[TYN_COLORS_ALBEDO].size[0];
    if (medium->albedo_grid && !albedo) { // it is black
        for (int c = 0; c < 3; c++) {
            b->sigma_a[c] += b->sigma_s[c];
            b->sigma_s[c] = 0;
        }
    }
    for (int c = 0; c < 3; c++) {
        sigma_a += b->sigma_a[c] + (albedo ? b->sigma_s[c] : 0);
        emission += medium->emission[c];
    }
    if (medium->emission_grid) {
        b->colors[TYN_COLORS_EMISSION] =
            tyn_colors_place(scene, emission > 0 ? medium->emission_grid : 0);
        // Without density, whatever its scale.
        const bool lit = b->colors[TYN_COLORS_EMISSION].size[0];
        for (int c = 0; c < 3; c++) {
            b->emission[c] = lit ? medium->emission[c] : 0;
        }
    }
    b->colors[TYN_COLORS_RADIANCE] =
        tyn_colors_place(scene, sigma_a > 0 ? medium->radiance_grid : 0);
    return b->colors[TYN_COLORS_RADIANCE].size[0];
}

static void build_shapes(tyn_frame_scene *out, const tyn_scene *scene, const rigid *m)
{
    out->empty = true;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_shape *shape = &scene->shapes[i];
        const tyn_medium *medium = &scene->media[shape->medium];
        const tyn_volume *volume = medium->volume < 0 ? NULL : &scene->volumes[medium->volume];
        struct shape_block *b = &out->shapes[i];
        local_from_m(shape, m, b->rows);
        b->kind = shape->kind == TYN_SHAPE_SPHERE ? TYN_SHAPE_KIND_SPHERE : TYN_SHAPE_KIND_BOX;
        b->offset[2] = tyn_atlas_offset(scene, medium->volume);
        for (int a = 0; a < 3; a++) {
            b->size[a] = volume ? volume->size[a] : 1;
            // A grid that is 0 everywhere holds nothing, whatever its coefficients.
            float scale = volume && volume->max_density <= 0 ? 0 : tyn_medium_scale(medium);
            b->sigma_s[a] = medium->sigma_s[a] * scale;
            b->sigma_a[a] = medium->sigma_a[a] * scale;
            b->phase[a] = medium->phase[a];
            b->emission[a] = medium->emission[a] * scale;
        }
        out->emissive |= build_colors(b, scene, medium);
        for (int a = 0; a < 3; a++) {
            // What emits by a grid of its own is there where the density is 0.
            const bool hollow =
                volume && volume->max_density <= 0 && !b->colors[TYN_COLORS_EMISSION].size[0];
            bool dark = b->sigma_s[a] + b->sigma_a[a] + b->emission[a] <= 0;
            out->empty &= dark || hollow;
            out->emissive |= b->emission[a] > 0;
        }
    }
}

// Where media overlap their extinctions add.
static float majorant_of(const tyn_frame_scene *f, const tyn_scene *scene)
{
    if (f->medium.mode == TYN_MEDIUM_DENSITY) {
        return f->medium.sigma_t_max * f->medium.max_density;
    }
    float sum = 0;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const int32_t volume = scene->media[scene->shapes[i].medium].volume;
        float most = 0;
        for (int c = 0; c < 3; c++) {
            const float sigma_t = f->shapes[i].sigma_s[c] + f->shapes[i].sigma_a[c];
            most = sigma_t > most ? sigma_t : most; // checked to be numbers
        }
        sum += most * (volume < 0 ? 1 : scene->volumes[volume].max_density);
    }
    return sum;
}

// ---- lights, camera, environment --------------------------------------------------------------

static float strength(const struct light_block *light)
{
    return light->color[0] + light->color[1] + light->color[2];
}

// The strongest first: methods take as many as they have grids for. Equal ones keep their order.
static void sort_suns(struct light_block *suns, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        const struct light_block sun = suns[i];
        uint32_t at = i;
        for (; at > 0 && strength(&suns[at - 1]) < strength(&sun); at--) {
            suns[at] = suns[at - 1];
        }
        suns[at] = sun;
    }
}

// Lights that do not shine are left out: nobody lays out grids or shadow maps for them.
static void build_lights(tyn_frame_scene *out, const tyn_scene *scene, const rigid *m)
{
    tyn_lights *lights = &out->lights;
    for (int pass = 0; pass < 2; pass++) { // directional lights first
        for (uint32_t i = 0; i < scene->num_lights; i++) {
            const tyn_light *light = &scene->lights[i];
            if ((light->kind == TYN_LIGHT_DIRECTIONAL) != (pass == 0) || !vec_any(light->color)) {
                continue;
            }
            struct light_block *b = &lights->scene[lights->num_directional + lights->num_lamps];
            *b = tyn_light_block(light);
            to_m_position(m, light->position, b->position);
            to_m_direction(m, light->direction, b->direction);
            float *d = b->direction, n = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            const bool aims = n > 0 && tyn_light_traits_of(light->kind)->has_direction;
            for (int a = 0; a < 3; a++) {
                d[a] = aims ? d[a] / n : (float)(a == 2);
            }
            if (pass == 1) {
                b->shadow = TYN_SHADOW_LAMP(lights->num_lamps);
            }
            *(pass ? &lights->num_lamps : &lights->num_directional) += 1;
        }
    }
    sort_suns(lights->scene, lights->num_directional);
    memcpy(lights->suns, lights->scene, lights->num_directional * sizeof *lights->suns);
    lights->num_suns = lights->num_directional;
}

static void build_camera(tyn_frame_scene *out, const tyn_view *view, const tyn_frame_projection *p,
                         const rigid *m)
{
    struct camera_block *b = &out->camera;
    double from[3];
    for (int i = 0; i < 3; i++) {
        from[i] = p->origin[i] - m->origin[i];
    }
    for (int a = 0; a < 3; a++) {
        b->origin[a] = (float)vec_dot(m->axes[a], from);
        b->right[a] = (float)vec_dot(m->axes[a], p->right);
        b->up[a] = (float)vec_dot(m->axes[a], p->up);
        b->forward[a] = (float)vec_dot(m->axes[a], p->forward);
    }
    b->orthographic = p->orthographic;
    b->half_width = (float)p->half[0];
    b->half_height = (float)p->half[1];
    b->background = !view->no_background;
    b->size[0] = view->width;
    b->size[1] = view->height;
    for (int i = 0; i < 2 && view->whole[0]; i++) {
        b->corner[i] = view->corner[i];
        b->beyond[i] = view->whole[i] - b->size[i];
    }
    b->shift[0] = (float)p->shift[0];
    b->shift[1] = (float)p->shift[1];
}

// The map's suns as directional lights among those of the scene.
static void build_map_suns(tyn_frame_scene *out, const tyn_map_light *map)
{
    const struct env_block *env = &out->environment;
    out->map = map;
    for (uint32_t i = 0; i < map->num_suns; i++) {
        const tyn_map_sun *sun = &map->suns[i];
        struct light_block *b = &out->lights.suns[out->lights.num_suns];
        *b = (struct light_block){.kind = TYN_LIGHT_KIND_DIRECTIONAL,
                                  .mean_cosine = sun->mean_cosine};
        for (int a = 0; a < 3; a++) {
            b->color[a] = env->radiance[a] * (float)sun->irradiance[a];
            for (int r = 0; r < 3; r++) {
                b->direction[a] -= env->rows[r][a] * sun->direction[r];
            }
        }
        out->lights.num_suns += vec_any(b->color);
    }
    sort_suns(out->lights.suns, out->lights.num_suns);
}

static void build_environment(tyn_frame_scene *out, const tyn_environment *env,
                              const tyn_map_light *map, const rigid *m)
{
    struct env_block *b = &out->environment;
    const bool has_map = env->size[0] && env->size[1];
    const float mean[3] = {(float)map->mean[0], (float)map->mean[1], (float)map->mean[2]};
    if (!env->present || !vec_any(env->radiance) || (has_map && !vec_any(mean))) {
        return; // it is black
    }
    b->has_map = has_map;
    b->size[0] = env->size[0];
    b->size[1] = env->size[1];
    const float *q = env->rotation;
    // An even sky stays as it is, however it is turned.
    const double n = has_map ? sqrt((double)q[0] * q[0] + (double)q[1] * q[1] +
                                    (double)q[2] * q[2] + (double)q[3] * q[3])
                             : 0;
    double x = n > 0 ? q[0] / n : 0, y = n > 0 ? q[1] / n : 0, z = n > 0 ? q[2] / n : 0;
    double w = n > 0 ? q[3] / n : 1;
    const double map_to_world[3][3] = {
        // columns: the map's axes in the world
        {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
        {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
        {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
    for (int r = 0; r < 3; r++) {
        for (int a = 0; a < 3; a++) {
            b->rows[r][a] = (float)vec_dot(map_to_world[r], m->axes[a]);
        }
        b->radiance[r] = env->radiance[r] * tyn_environment_strength(env);
        b->mean[r] = b->radiance[r] * (b->has_map ? (float)map->mean[r] : 1.0f);
        b->sky[r] = b->radiance[r] * (b->has_map ? (float)map->sky[r] : 1.0f);
    }
    build_map_suns(out, map);
}

// ---- surfaces ---------------------------------------------------------------------------------

// In the arithmetic of surface_cross (surface_trace.glsl), whose bounds of rounding are these.
static void build_few(struct surface_corners *few, const tyn_surfaces *surfaces)
{
    const float rounding = 4 * 5.9604645e-8f;
    for (uint32_t i = 0; i < surfaces->num_triangles; i++) {
        struct surface_corners *c = &few[i];
        float *corners[3] = {c->v0, c->v1, c->v2}, e1[3], e2[3];
        for (int k = 0; k < 3; k++) {
            const uint32_t v = surfaces->triangles[i].vertices[k];
            memcpy(corners[k], surfaces->vertices[v].position, sizeof c->v0);
        }
        for (int a = 0; a < 3; a++) {
            e1[a] = c->v1[a] - c->v0[a];
            e2[a] = c->v2[a] - c->v0[a];
        }
        for (int a = 0; a < 3; a++) {
            const float p = e1[(a + 1) % 3] * e2[(a + 2) % 3],
                        q = e1[(a + 2) % 3] * e2[(a + 1) % 3];
            c->normal[a] = p - q;
            c->rounding[a] = rounding * (fabsf(p) + fabsf(q));
        }
    }
}

static void build_surfaces(tyn_frame_scene *out, const tyn_surfaces *surfaces,
                           const tyn_surface_data *data, const rigid *m)
{
    struct surface_block *b = &out->surfaces;
    if (!data->hash) {
        return;
    }
    out->num_triangles = b->num_triangles = surfaces->num_triangles;
    out->num_vertices = surfaces->num_vertices;
    out->emitters = data->emitters ? ((const struct surface_table *)data->emitters)->weight : 0.0f;
    out->num_textures = surfaces->num_textures;
    if (surfaces->num_triangles <= TYN_SURFACE_FEW) {
        build_few(b->few, surfaces);
    }
    b->num_nodes = surfaces->num_nodes ? surfaces->num_nodes : 1;
    out->below = data->below;
    out->seen = data->seen;
    for (int r = 0; r < 3; r++) {
        for (int a = 0; a < 3; a++) {
            b->to_world[r][a] = (float)m->axes[a][r];
            b->from_world[r][a] = (float)m->axes[r][a];
        }
        b->to_world[r][3] = (float)m->origin[r];
        b->from_world[r][3] = (float)-vec_dot(m->axes[r], m->origin);
        b->lo[r] = data->lo[r];
        b->hi[r] = data->hi[r];
    }
}

// ---- all --------------------------------------------------------------------------------------

uint32_t tyn_volume_open_faces(const tyn_volume *volume)
{
    if (!volume->data) {
        return 63;
    }
    const uint32_t *n = volume->size;
    const size_t stride[3] = {1, n[0], (size_t)n[0] * n[1]};
    uint32_t open = 0;
    for (int a = 0; a < 3; a++) {
        int u = (a + 1) % 3, v = (a + 2) % 3;
        for (size_t j = 0; j < n[v]; j++) {
            for (size_t i = 0; i < n[u]; i++) {
                const float *low = volume->data + i * stride[u] + j * stride[v];
                open |= low[0] != 0.0f ? 1u << (2 * a) : 0;
                open |= low[(n[a] - 1) * stride[a]] != 0.0f ? 2u << (2 * a) : 0;
            }
        }
    }
    return open;
}

float tyn_volume_mean(const tyn_volume *volume)
{
    size_t count = (size_t)volume->size[0] * volume->size[1] * volume->size[2], filled = 0;
    double sum = 0;
    for (size_t i = 0; volume->data && i < count; i++) {
        sum += volume->data[i];
        filled += volume->data[i] > 0;
    }
    return filled ? (float)(sum / (double)filled) : 0;
}

float tyn_volume_typical(const tyn_volume *volume)
{
    size_t count = (size_t)volume->size[0] * volume->size[1] * volume->size[2];
    double sum = 0, squares = 0;
    for (size_t i = 0; volume->data && i < count; i++) {
        sum += volume->data[i];
        squares += (double)volume->data[i] * (double)volume->data[i];
    }
    return sum > 0 ? (float)(squares / sum) : 0;
}

tyn_result tyn_frame_scene_build(tyn_frame_scene *out, const tyn_scene *scene, const tyn_view *view,
                                 const tyn_frame_projection *projection, const tyn_map_light *map,
                                 const tyn_surface_data *surfaces, const tyn_log *log)
{
    memset(out, 0, sizeof *out);
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const bool *repeat = scene->shapes[i].repeat;
        if ((repeat[0] || repeat[1] || repeat[2]) && scene->num_shapes > 1) {
            return TYN_FAULT(
                log, TYN_ERR_UNSUPPORTED,
                "shape %u repeats, but the scene has %u shapes; a periodic medium must be "
                "the only one",
                i, scene->num_shapes);
        }
    }
    rigid m;
    double extent[3];
    bool mirrored = false;
    bool unsheared =
        scene->num_shapes == 1 && frame_of_shape(&scene->shapes[0], &m, extent, &mirrored);
    if (!unsheared) {
        frame_of_world(scene, surfaces, &m, extent);
    }
    // The atlas can serve as the density texture if it holds this grid alone.
    tyn_atlas atlas;
    TYN_TRY(tyn_atlas_plan(&atlas, scene, log));
    const bool colors = scene->num_shapes && has_colors(&scene->media[scene->shapes[0].medium]);
    out->direct = unsheared && !mirrored && !colors && scene->shapes[0].kind == TYN_SHAPE_BOX &&
                  (scene->media[scene->shapes[0].medium].volume < 0
                       ? scene->num_volumes == 0
                       : scene->num_volumes == 1 && atlas.extent.z == scene->volumes[0].size[2]);
    if (scene->num_shapes) {
        build_medium(out, scene, extent);
    } else if (surfaces->hash) {
        build_void(out, extent);
    }
    for (int a = 0; a < 3; a++) { // without media M has the axes of the world
        const bool most = !scene->num_shapes && surfaces->hash;
        out->near_lo[a] = most ? surfaces->most_lo[a] - (float)m.origin[a] : 0;
        out->near_hi[a] = most ? surfaces->most_hi[a] - (float)m.origin[a] : out->medium.extent[a];
    }
    build_shapes(out, scene, &m);
    out->majorant = majorant_of(out, scene);
    build_lights(out, scene, &m);
    build_camera(out, view, projection, &m);
    build_environment(out, &scene->environment, map, &m);
    build_surfaces(out, &scene->surfaces, surfaces, &m);
    for (int a = 0; a < 3; a++) {
        for (int j = 0; j < 3; j++) {
            out->m_from_world[j * 4 + a] = (float)m.axes[a][j];
        }
        out->m_from_world[12 + a] = (float)-vec_dot(m.axes[a], m.origin);
    }
    out->m_from_world[15] = 1;
    return TYN_OK;
}
