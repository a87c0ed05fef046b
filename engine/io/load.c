// load.c -- any scene by its file extension.
#include <tyndall/io.h>
#include <math.h>
#include <stdlib.h>
#include "io/bare.h"
#include "io/gltf.h"
#include "io/volume.h"
#include "base/given.h"

static tyn_result load_gltf(tyn_scene *scene, const char *path, const char *environment,
                            const tyn_moment *moment, const tyn_log *log)
{
    void *bytes;
    size_t size;
    tyn_result r = tyn_file_read(path, 0x7fffffff, &bytes, &size, log);
    if (!r) {
        r = tyn_gltf_parse(scene, bytes, size, path, environment, moment, log);
        free(bytes);
    }
    return r;
}

static tyn_result load_bare(tyn_scene *scene, const char *path, const char *environment,
                            const tyn_log *log)
{
    tyn_grid_job job = {.log = log};
    tyn_result r = tyn_grid_read(&job, path);
    if (r) {
        return r;
    }
    r = tyn_bare_scene(scene, &job.volume, environment, log);
    if (!r && job.clamped) {
        scene->clamped_negative = job.clamped;
        tyn_scene_warn(scene, "%s: %llu negative densities were set to 0", path,
                       (unsigned long long)job.clamped);
    }
    if (!r && job.guessed) {
        tyn_scene_warn(scene, "%s: is taken for the density: none is called so",
                       scene->volumes[0].name ? scene->volumes[0].name : path);
    }
    if (!r && job.left_out[0]) {
        tyn_scene_warn(scene, "%s: left out of the file: %s", path, job.left_out);
    }
    return r;
}

static tyn_result load(tyn_scene *scene, const char *path, const char *environment,
                       const tyn_moment *moment, const tyn_log *log)
{
    tyn_scene_init(scene);
    if (!TYN_GIVEN(log, scene, path)) {
        return TYN_ERR_PARAMS;
    }
    if (moment && moment->timed && !isfinite(moment->seconds)) {
        return TYN_FAULT(log, TYN_ERR_PARAMS, "%s: a time of %g s: must be finite", path,
                         moment->seconds);
    }
    if (tyn_is_gltf(path)) {
        return load_gltf(scene, path, environment, moment, log);
    }
    if (tyn_is_volume(path)) {
        return load_bare(scene, path, environment, log);
    }
    return TYN_FAULT(log, TYN_ERR_PARAMS,
                     "%s: unknown kind of scene: must be one of .gltf, .glb" TYN_VOLUME_ENDINGS,
                     path);
}

tyn_result tyn_scene_load(tyn_scene *scene, const char *path, const char *environment,
                          const tyn_log *log)
{
    return load(scene, path, environment, NULL, log);
}

tyn_result tyn_scene_load_frame(tyn_scene *scene, const char *path, const char *environment,
                                uint32_t frame, const tyn_log *log)
{
    const tyn_moment moment = {.numbered = true, .frame = frame};
    return load(scene, path, environment, &moment, log);
}

tyn_result tyn_scene_load_moment(tyn_scene *scene, const char *path, const char *environment,
                                 const tyn_moment *moment, const tyn_log *log)
{
    return load(scene, path, environment, moment, log);
}
