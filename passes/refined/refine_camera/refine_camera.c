// refine_camera.c -- see refine_camera.h.
#include "refine_camera.h"

static const tyn_port ports[] = {REFINE_CAMERA_PORTS(TYN_PORT_ROW)};

void tyn_refine_camera(const struct camera_block *from, uint32_t grid, struct camera_block *to)
{
    float *half[2] = {&to->half_width, &to->half_height};
    *to = *from;
    for (int a = 0; a < 2; a++) {
        const double whole = (double)from->size[a] + (double)from->beyond[a];
        const uint32_t size = (from->size[a] + grid - 1) / grid;
        // Half sizes of the part's own picture, in those of the whole; where its first edge is, -1 to 1 in the whole.
        const double part = (double)size * grid / whole, edge = 2 * from->corner[a] / whole - 1;
        const double sign = a == 0 ? 1 : -1; // rows run down
        *half[a] *= (float)part;
        to->shift[a] = (float)(sign * ((edge + sign * (double)from->shift[a]) / part + 1));
        to->size[a] = size;
        to->corner[a] = to->beyond[a] = 0;
    }
}

static tyn_result declare(tyn_builder *b, const void *params)
{
    (void)params;
    tyn_build_buffer(b, REFINE_CAMERA_PORT_CAMERA, sizeof(struct camera_block));
    return TYN_OK;
}

static void record(tyn_recorder *r, const void *params)
{
    const tyn_refine_camera_params *p = params;
    tyn_rec_update(r, REFINE_CAMERA_PORT_CAMERA, 0, &p->camera, sizeof p->camera);
}

const tyn_pass_desc tyn_pass_refine_camera = {
    .name = "refine_camera",
    .summary = "the view's camera for an image of samples",
    .serves = "refinement with fewer samples than pixels (refine.grid)",
    .ports = ports,
    .num_ports = TYN_COUNT(ports),
    .params_size = sizeof(tyn_refine_camera_params),
    .declare = declare,
    .record = record,
    .debug_port = REFINE_CAMERA_PORT_CAMERA,
    .debug_meaning = "the camera",
};
