// gltf_animation.c -- where a glTF file's animations put its nodes at a time (glTF 2.0, 3.11 and appendix C).
#include "io/gltf_animation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef enum interpolation { LINEAR, STEP, CUBIC } interpolation;

// One sampler: keys, and a value a key (three with CUBIC: in-tangent, value, out-tangent).
typedef struct track {
    gltf_floats times, values;
    interpolation how;
} track;

static void track_finish(track *t)
{
    free(t->times.values);
    free(t->values.values);
    *t = (track){0};
}

static tyn_result read_track(track *t, const gltf_data *data, const cJSON *sampler,
                             uint32_t components)
{
    static const char *const names[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    const json_doc *doc = data->doc;
    const cJSON *input = tyn_json_member(sampler, "input");
    const cJSON *output = tyn_json_member(sampler, "output");
    const char *how = names[LINEAR];
    int64_t unused;
    if (!input || !output) {
        return tyn_json_fault(doc, sampler, "needs input and output, indices of accessors");
    }
    TYN_TRY(
        tyn_json_index(doc, input, data->model->lists[GLTF_ACCESSORS].count, "accessors", &unused));
    TYN_TRY(tyn_json_index(doc, output, data->model->lists[GLTF_ACCESSORS].count, "accessors",
                           &unused));
    TYN_TRY(tyn_json_string(doc, sampler, "interpolation", &how));
    while ((int)t->how <= CUBIC && strcmp(how, names[t->how]) != 0) {
        t->how++;
    }
    if ((int)t->how > CUBIC) {
        return tyn_json_fault(doc, tyn_json_member(sampler, "interpolation"),
                              "must be LINEAR, STEP or CUBICSPLINE");
    }
    TYN_TRY(tyn_gltf_read_floats(data, input, 1, 1, &t->times));
    TYN_TRY(tyn_gltf_read_floats(data, output, components, components, &t->values));
    if (t->values.count != t->times.count * (t->how == CUBIC ? 3 : 1)) {
        return tyn_json_fault(doc, output, "has %u elements for %u keys, must have %u",
                              t->values.count, t->times.count,
                              t->times.count * (t->how == CUBIC ? 3 : 1));
    }
    for (uint32_t i = 1; i < t->times.count; i++) {
        if (!(t->times.values[i] > t->times.values[i - 1])) {
            return tyn_json_fault(doc, input, "key %u is at %g s, not after %g s", i,
                                  (double)t->times.values[i], (double)t->times.values[i - 1]);
        }
    }
    return TYN_OK;
}

// Value (part 1), in-tangent (0) or out-tangent (2) of a key.
static const float *key(const track *t, uint32_t i, uint32_t part)
{
    const uint32_t at = t->how == CUBIC ? 3 * i + part : i;
    return t->values.values + (size_t)at * t->values.components;
}

static double dot4(const float *a, const float *b)
{
    double sum = 0;
    for (int c = 0; c < 4; c++) {
        sum += (double)a[c] * (double)b[c];
    }
    return sum;
}

// Along the shorter arc between two quaternions.
static void slerp(const float *a, const float *b, double u, double out[4])
{
    const double d = dot4(a, b), sign = d < 0 ? -1 : 1, angle = acos(fmin(fabs(d), 1));
    const double s = sin(angle);
    const double wa = s > 1e-6 ? sin((1 - u) * angle) / s : 1 - u;
    const double wb = s > 1e-6 ? sin(u * angle) / s : u;
    for (int c = 0; c < 4; c++) {
        out[c] = wa * (double)a[c] + sign * wb * (double)b[c];
    }
}

static void evaluate(const track *t, double seconds, double *out)
{
    const uint32_t n = t->times.count, components = t->values.components;
    uint32_t next = 0; // first key after `seconds`
    while (next < n && (double)t->times.values[next] <= seconds) {
        next++;
    }
    const uint32_t i = next > 0 ? next - 1 : 0;
    if (next == 0 || next == n || t->how == STEP) {
        for (uint32_t c = 0; c < components; c++) {
            out[c] = (double)key(t, i, 1)[c];
        }
        return;
    }
    const double span = (double)t->times.values[next] - (double)t->times.values[i];
    const double u = (seconds - (double)t->times.values[i]) / span, u2 = u * u, u3 = u2 * u;
    if (t->how == LINEAR && components == 4) {
        slerp(key(t, i, 1), key(t, next, 1), u, out);
        return;
    }
    for (uint32_t c = 0; c < components; c++) {
        const double a = (double)key(t, i, 1)[c], b = (double)key(t, next, 1)[c];
        out[c] = a + u * (b - a);
        if (t->how == CUBIC) {
            const double leaves = span * (double)key(t, i, 2)[c];
            const double arrives = span * (double)key(t, next, 0)[c];
            out[c] = (2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * leaves +
                     (3 * u2 - 2 * u3) * b + (u3 - u2) * arrives;
        }
    }
}

// A channel's target; NULL: it moves something else.
static double *target_of(gltf_node *node, const char *path, uint32_t *components)
{
    *components = strcmp(path, "rotation") == 0 ? 4 : 3;
    return strcmp(path, "translation") == 0 ? node->translation
           : strcmp(path, "rotation") == 0  ? node->rotation
           : strcmp(path, "scale") == 0     ? node->scale
                                            : NULL;
}

static tyn_result play_channel(gltf_model *model, double seconds, const gltf_data *data,
                               const cJSON *channel, const json_list *samplers, bool *weights)
{
    const json_doc *doc = data->doc;
    cJSON *target;
    const char *path = "";
    int64_t node, index;
    uint32_t components;
    TYN_TRY(tyn_json_object(doc, channel, "target", &target));
    TYN_TRY(tyn_json_string(doc, target, "path", &path));
    const cJSON *of = tyn_json_member(target, "node"), *by = tyn_json_member(channel, "sampler");
    *weights = *weights || strcmp(path, "weights") == 0;
    if (!of || !by) {
        return by ? TYN_OK
                  : tyn_json_fault(doc, channel, "sampler is missing: an index of samplers");
    }
    TYN_TRY(tyn_json_index(doc, of, model->lists[GLTF_NODES].count, "nodes", &node));
    TYN_TRY(tyn_json_index(doc, by, samplers->count, "samplers", &index));
    double *moved = target_of(&model->nodes[node], path, &components);
    if (!moved) {
        return TYN_OK;
    }
    if (model->nodes[node].has_matrix) {
        return tyn_json_fault(doc, of,
                              "this node has a matrix: only translation, rotation and "
                              "scale can be animated");
    }
    track t = {0};
    tyn_result r = read_track(&t, data, samplers->items[index], components);
    double value[4];
    if (!r) {
        evaluate(&t, seconds, value);
        double length = 0;
        for (uint32_t c = 0; c < components; c++) {
            length += value[c] * value[c];
        }
        if (components == 4 && !(length > 1e-12)) {
            r = tyn_json_fault(doc, channel, "gives a quaternion of length 0 at %g s", seconds);
        } else {
            memcpy(moved, value, components * sizeof *value);
        }
    }
    track_finish(&t);
    return r;
}

tyn_result tyn_gltf_animate(gltf_model *model, double seconds, const gltf_data *data,
                            tyn_scene *scene)
{
    json_list animations = {0};
    bool weights = false;
    tyn_result r = tyn_json_list(data->doc, data->doc->root, "animations", &animations);
    for (int64_t i = 0; !r && i < animations.count; i++) {
        json_list channels = {0}, samplers = {0};
        r = tyn_json_list(data->doc, animations.items[i], "channels", &channels);
        r = r ? r : tyn_json_list(data->doc, animations.items[i], "samplers", &samplers);
        for (int64_t k = 0; !r && k < channels.count; k++) {
            r = play_channel(model, seconds, data, channels.items[k], &samplers, &weights);
        }
        free(channels.items);
        free(samplers.items);
    }
    free(animations.items);
    if (!r && weights) {
        tyn_scene_warn(scene, "animations: weights of morph targets are left out");
    }
    return r;
}

void tyn_gltf_warn_of_animations(const json_doc *doc, tyn_scene *scene)
{
    const int count = cJSON_GetArraySize(tyn_json_member(doc->root, "animations"));
    if (count > 0) {
        tyn_scene_warn(scene,
                       "%d animation%s: nodes are shown as they stand without; a time moves them",
                       count, count > 1 ? "s" : "");
    }
}
