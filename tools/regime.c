// regime.c -- the regime of a scene from its media, lights and surfaces.
#include "regime_parts.h"
#include <stdlib.h>

bool regime_of(const tyn_scene *scene, const tyn_camera *camera, regime *r)
{
    tyn_camera framed;
    regime_box b;
    double emitted[3] = {0};
    regime_media *media = malloc(sizeof *media);
    if (!media) {
        return false;
    }
    *r = (regime){.num_triangles = scene->surfaces.num_triangles};
    regime_media_make(scene, media);
    const bool found = regime_box_of(scene, &b);
    if (found && scene->num_shapes && !regime_of_medium(media, &b, r, emitted)) {
        free(media);
        return false;
    }
    regime_of_light(scene, &b, emitted, r);
    for (uint32_t i = 0; i < scene->num_volumes; i++) {
        const uint32_t *size = scene->volumes[i].size;
        r->voxels += (uint64_t)size[0] * size[1] * size[2];
    }
    for (uint32_t i = 0; i < scene->num_shapes; i++) {
        const bool *repeat = scene->shapes[i].repeat;
        r->periodic |= repeat[0] || repeat[1] || repeat[2];
    }
    if (!camera && scene->num_cameras) {
        camera = &scene->cameras[0];
    } else if (!camera) {
        tyn_camera_frame_scene(&framed, scene);
        camera = &framed;
    }
    regime_of_view(media, &b, camera, r);
    free(media);
    return true;
}

double regime_multiple(const regime *r)
{
    return r->albedo * r->optical_depth / (2 + r->optical_depth);
}

double regime_longest(const regime *r)
{
    return fmax(r->sides[0], fmax(r->sides[1], r->sides[2]));
}

double regime_cells(const regime *r, double cells)
{
    enum { MOST_ALONG = 256, MOST_IN_ALL = 64 * 64 * 64 };
    const double longest = regime_longest(r);
    for (cells = fmin(cells, MOST_ALONG); cells > 1; cells--) {
        double all = 1;
        for (int a = 0; a < 3; a++) {
            const double exact = longest > 0 ? r->sides[a] / longest * cells : 1;
            all *= fmax(1, ceil(exact - 1e-4));
        }
        if (all <= MOST_IN_ALL) {
            break;
        }
    }
    return cells;
}
