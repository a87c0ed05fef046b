// scene_box.c -- figures of a frame's scene: boxes, periods, range of g.
#include <tyndall/extend/job.h>
#include <math.h>
#include <string.h>

enum { MOST_WITHOUT_HIERARCHY = 256 }; // triangles that every ray may be tested against

bool tyn_can_trace(const tyn_job *job)
{
    return job->refs.geometry.nodes.resource || job->frame->num_triangles <= MOST_WITHOUT_HIERARCHY;
}

void tyn_range_of_g(const tyn_scene *scene, float *least, float *most)
{
    *least = 1.0f;
    *most = -1.0f;
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const tyn_medium *m = &scene->media[scene->shapes[i].medium];
        for (int c = 0; c < 3; c++) {
            if (m->sigma_s[c] * tyn_medium_scale(m) > 0.0f) {
                const float g = (float)tyn_phase_mean_cosine(m->phase[c]);
                *least = fminf(*least, g);
                *most = fmaxf(*most, g);
            }
        }
    }
    if (*least > *most) {
        *least = *most = 0.0f;
    }
}

void tyn_surfaces_box(const tyn_frame_scene *frame, float lo[3], float hi[3])
{
    const struct surface_block *s = &frame->surfaces;
    for (int a = 0; a < 3; a++) {
        float centre = s->from_world[a][3], reach = 0;
        for (int w = 0; w < 3; w++) {
            centre += s->from_world[a][w] * 0.5f * (s->lo[w] + s->hi[w]);
            reach += fabsf(s->from_world[a][w]) * 0.5f * (s->hi[w] - s->lo[w]);
        }
        lo[a] = centre - reach;
        hi[a] = centre + reach;
    }
}

static void include(float lo[3], float hi[3], const float p[3])
{
    for (int a = 0; a < 3; a++) {
        lo[a] = fminf(lo[a], p[a]);
        hi[a] = fmaxf(hi[a], p[a]);
    }
}

void tyn_scene_box(const tyn_frame_scene *frame, float lo[3], float hi[3])
{
    const struct medium_block *m = &frame->medium;
    float corners[2][3], size = 0;
    memset(lo, 0, 3 * sizeof *lo);
    memcpy(hi, m->extent, 3 * sizeof *hi);
    tyn_surfaces_box(frame, corners[0], corners[1]);
    include(lo, hi, corners[0]);
    include(lo, hi, corners[1]);
    for (uint32_t i = 0; i < frame->lights.num_lamps; i++) {
        include(lo, hi, tyn_first_lamp(&frame->lights)[i].position);
    }
    for (int a = 0; a < 3; a++) {
        size = fmaxf(size, hi[a] - lo[a]);
    }
    for (int a = 0; a < 3; a++) {
        lo[a] = m->repeat[a] ? 0 : lo[a] - 0.05f * size;
        hi[a] = m->repeat[a] ? m->extent[a] : hi[a] + 0.05f * size;
    }
}

bool tyn_has_walls(const tyn_frame_scene *frame)
{
    if (frame->num_triangles == 0) {
        return false;
    }
    // The surfaces' box in M, and the media's with the cells beside it, which are at most a quarter of it.
    const float *m = frame->m_from_world, *extent = frame->medium.extent;
    float longest = fmaxf(extent[0], fmaxf(extent[1], extent[2]));
    for (int axis = 0; axis < 3; axis++) {
        float lo = m[12 + axis], hi = lo;
        for (int k = 0; k < 3; k++) {
            float a = m[4 * k + axis] * frame->surfaces.lo[k],
                  b = m[4 * k + axis] * frame->surfaces.hi[k];
            lo += fminf(a, b);
            hi += fmaxf(a, b);
        }
        if (hi < -0.25f * longest || lo > extent[axis] + 0.25f * longest) {
            return false;
        }
    }
    return true;
}

bool tyn_is_periodic(const tyn_frame_scene *frame)
{
    const tyn_uint *repeat = frame->medium.repeat;
    return repeat[0] || repeat[1] || repeat[2];
}
