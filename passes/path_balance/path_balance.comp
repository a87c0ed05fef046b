// path_balance.comp -- where the energy goes, by paths from random points: inside the media for
// what they absorb and emit, on solid surfaces for what these absorb, on the boundary for what
// comes in and goes out. The kinds of points know nothing of each other, so that the sums agree is
// a check. The boundary is that of the media; with solid surfaces a box around everything. Next to
// lamps light is too uneven for such points: where there are surfaces, the first flights of
// lamplight are followed from the lamps, and the points are spared it. And a boundary's point
// hardly ever finds the small patches that lamps light: what surfaces reflect out of the box is
// followed from the surfaces.
#include "shaders/path/path_args.h"

const bool PROBE = true;
#include "shaders/path/path_resources.glsl"

TYN_WRITE(18, partials, path_balance_partial partials[]);
TYN_UPDATE(19, counters, counters_block counters);
TYN_READ(20, areas, surface_table areas; surface_cell area_cells[]);

const uint IN_MEDIA = 0u, ON_BOUNDARY = 1u, ON_SURFACE = 2u, AT_LIGHT = 3u;
uint place;
#define PATH_ENDS_AT_FIRST_SURFACE (place == ON_BOUNDARY)
#include "shaders/path/path.glsl"
#include "shaders/path/path_entry.glsl"
#include "shaders/path/path_heading.glsl"

path_balance_partial partial;
const bool FROM_LIGHTS = (FLAGS & TYN_PATH_FROM_LIGHTS) != 0u;

// How many kinds of points there are.
uint num_places()
{
    if (FROM_LIGHTS) { // not by ?:, of which glslang 12 makes invalid constants
        return 4u;
    }
    if (SURFACES) {
        return 3u;
    }
    return 2u;
}

vec3 normal;      // of the boundary, outwards, or of the surface
vec3 measure;     // what a unit of radiance per steradian at the point stands for: area, or volume times sigma_a
vec3 emitted;     // of the media at the point, W
vec3 direct_in, direct_out; // of lamps and suns; direct_out: inside, absorbed
vec3 light_media, light_surfaces, light_escaped; // where a lamp's light ends its first flight, W
vec3 group_entering, group_emitted, group_media, group_escaped, group_solid; // sums of a group of samples, W
vec3 kept;     // of the light that arrives at a surface, what it absorbs,
vec3 sent_out; // and what it reflects and leaves without meeting anything

// A point of a box's surface, from numbers in [0, 1).
vec3 box_face_point(vec3 lo, vec3 hi, uvec4 bits)
{
    vec3 size = hi - lo, random = vec3(rng_vec2(bits.xy), rng_float(bits.z));
    uint face = min(uint(rng_float(bits.w) * 6.0), 5u);
    vec3 along = vec3(equal(uvec3(face >> 1), uvec3(0u, 1u, 2u)));
    float side = float(face & 1u);
    normal = (2.0 * side - 1.0) * along;
    bool periodic = dot(along, vec3(medium.repeat)) > 0.0; // there is no face there
    float area = dot(along, size.yzx * size.zxy);
    measure = vec3(periodic ? 0.0 : 6.0 * area);
    return lo + mix(random, vec3(side), greaterThan(along, vec3(0.0))) * size;
}

// What is left, out of sight of everything, of light that goes on from a surface by the cosine.
vec3 reflected_out(path_state path, const surface_point point, vec3 side, inout rng_state rng)
{
    uvec4 bits = rng_next(rng);
    path.vertex = surface_offset(point, side);
    path.way = cosine_sample(side, rng_vec2(bits.xy));
    surface_hit ahead = surface_hit(PATH_FAR, SURFACE_NONE, vec2(0.0));
    vec3 period;
    if (surface_trace(path.vertex, path.way, true, ahead, period)) {
        return vec3(0.0);
    }
    path.end = PATH_FAR;
    bool met = false;
    path_flight f = path_fly(path, rng, met);
    return f.collided ? vec3(0.0) : path_weight(path);
}

path_state path_new(float u)
{
    path_state path;
    path.beta = vec3(1.0);
    path.rho = vec3(1.0);
    path.hero = GREY ? vec3(1.0, 0.0, 0.0) : vec3(u < 1.0, u >= 1.0 && u < 2.0, u >= 2.0);
    path.depth = 0u;
    path.steps = 0u;
    return path;
}

// A point of the triangles, on either side.
vec3 solid_point(uvec4 bits, inout rng_state rng)
{
    uint high, low;
    umulExtended(bits.x, areas.count, high, low);
    uint index = surface_cell_pick(area_cells[high], bits.y);
    vec2 barycentric = triangle_sample(rng_vec2(bits.zw));
    surface_point point = surface_point_at(index, barycentric);
    surface_material material = surface_material_at(surface_triangle_at(index).w);
    uvec4 more = rng_next(rng);
    normal = rng_float(more.x) < 0.5 ? point.normal : -point.normal;
    measure = vec3(2.0 * areas.weight);
    vec3 albedo = surface_albedo(material, index, barycentric);
    kept = 1.0 - albedo;
    sent_out = albedo * reflected_out(path_new(3.0 * rng_float(more.y)), point, normal, rng);
    return surface_offset(point, normal);
}

// A point of the unit box's or the sphere's surface, and its outward normal there.
vec3 media_face_local(const shape_block shape, vec3 random, out vec3 outward, out float area)
{
    if (shape_is_sphere(shape)) {
        float z = 1.0 - 2.0 * random.x, r = sqrt(max(1.0 - z * z, 0.0)), azimuth = 2.0 * HG_PI * random.y;
        outward = vec3(r * cos(azimuth), r * sin(azimuth), z);
        area = HG_PI;
        return 0.5 * outward;
    }
    uint face = min(uint(random.z * 6.0), 5u), axis = face >> 1;
    float side = (face & 1u) != 0u ? 1.0 : -1.0;
    vec2 at = random.xy - 0.5;
    outward = side * vec3(axis == 0u, axis == 1u, axis == 2u);
    bool periodic = dot(abs(outward), vec3(medium.repeat)) > 0.0;
    area = periodic ? 0.0 : 6.0; // a periodic medium has no face there
    return 0.5 * outward +
           (axis == 0u ? vec3(0.0, at) : axis == 1u ? vec3(at.x, 0.0, at.y) : vec3(at, 0.0));
}

bool inside_another(uint own, vec3 p)
{
    for (uint i = 0u; i < medium.num_shapes && SHAPES != 1u; i++) {
        shape_block shape = shapes[i];
        if (i != own && shape_holds(shape, shape_local(shape, p))) {
            return true;
        }
    }
    return false;
}

vec3 media_face_point(uvec4 bits)
{
    uint count = SHAPES != 0u ? SHAPES : medium.num_shapes;
    uint own = min(uint(rng_float(bits.w) * float(count)), count - 1u);
    shape_block shape = shapes[own]; // an index that varies would drive path_shapes out of registers
    mat3 to_local = transpose(mat3(shape.rows[0].xyz, shape.rows[1].xyz, shape.rows[2].xyz));
    if (determinant(to_local) == 0.0) { // a scene without media
        measure = vec3(0.0);
        normal = vec3(0.0, 0.0, 1.0);
        return vec3(0.0);
    }
    mat3 from_local = inverse(to_local);
    vec3 outward;
    float area;
    vec3 local = media_face_local(shape, vec3(rng_vec2(bits.xy), rng_float(bits.z)), outward, area);
    vec3 p = from_local * (local - vec3(shape.rows[0].w, shape.rows[1].w, shape.rows[2].w));
    // Nanson: n dA = |det J| J^-T n' dA'.
    vec3 stretched = abs(determinant(from_local)) * (transpose(to_local) * outward);
    float stretch = length(stretched);
    normal = stretched / stretch;
    measure = vec3(area * stretch * float(count) * (inside_another(own, p) ? 0.0 : 1.0));
    return p;
}

vec3 volume_point(uvec4 bits)
{
    vec3 p = vec3(rng_vec2(bits.xy), rng_float(bits.z)) * medium.extent;
    float volume = medium.extent.x * medium.extent.y * medium.extent.z;
    media_point m = media_at(p, 0.0, vec3(1.0));
    if (HOMOGENEOUS && !shape_holds(path_shapes[0], shape_local(path_shapes[0], p))) {
        volume = 0.0;
    }
    measure = volume * max(m.sigma_t - m.sigma_s, 0.0);
    emitted = 4.0 * HG_PI * volume * m.emission;
    return p;
}

// The first flight of light from a lamp or a sun, drawn by power.
void follow_light(inout rng_state rng)
{
    float total = 0.0;
    for (uint i = 0u; i < args.num_lights; i++) {
        light_block light = light_get(i);
        total += light_drawn_by(light);
    }
    uvec4 bits = rng_next(rng), more = rng_next(rng);
    float left = rng_float(bits.x) * total, weight = 0.0;
    light_block lamp = light_get(args.num_lights - 1u);
    for (uint i = 0u; i < args.num_lights; i++) {
        light_block light = light_get(i);
        weight = light_drawn_by(light);
        if (left < weight) {
            lamp = light;
            break;
        }
        left -= weight;
    }
    bool sun = lamp.kind == TYN_LIGHT_KIND_DIRECTIONAL;
    vec3 random = vec3(rng_vec2(bits.yz), rng_float(more.x));
    vec3 way = sun ? lamp.direction : lamp_way(lamp, random.xy);
    float lobe = sun ? 1.0 : light_lobe(lamp, dot(way, lamp.direction));
    vec3 power = lamp.color * (lobe * total / max3(lamp.color));

    path_state path = path_new(3.0 * rng_float(bits.w));
    path.vertex = sun ? draw_entry(way, random) : lamp.position;
    path.way = way;
    surface_hit ahead = surface_hit(PATH_FAR, SURFACE_NONE, vec2(0.0));
    vec3 period;
    surface_trace(path.vertex, path.way, false, ahead, period);
    path.end = ahead.t;
    bool met = false;
    path_flight f = path_fly(path, rng, met);
    if (f.collided) {
        float sigma_t = GREY ? f.m.sigma_t.x : dot(f.m.sigma_t, path.hero);
        path.beta *= max(f.m.sigma_t - f.m.sigma_s, 0.0) / sigma_t;
        path.rho *= GREY ? vec3(1.0) : f.m.sigma_t / sigma_t;
        light_media = power * path_weight(path);
    } else if (path.end < PATH_FAR) {
        surface_finding found = surface_find(ahead, period, path.way);
        light_surfaces = power * path_weight(path) * (1.0 - found.albedo);
        path.beta *= found.albedo;
        light_escaped = power * reflected_out(path, found.point, found.point.normal, rng);
    } else {
        light_escaped = power * path_weight(path);
    }
}

uint beyond = 0u; // paths of this thread in the next block

bool path_next(inout uint element, inout uint first, inout uint end)
{
    if (beyond == 0u) {
        return false;
    }
    element++;
    first = 0u;
    end = beyond;
    beyond = 0u;
    return true;
}

void path_begin(inout rng_state rng, vec2 random, out vec3 origin, out vec3 direction)
{
    emitted = vec3(0.0);
    direct_in = vec3(0.0);
    direct_out = vec3(0.0);
    light_media = vec3(0.0);
    light_surfaces = vec3(0.0);
    light_escaped = vec3(0.0);
    kept = vec3(0.0);
    sent_out = vec3(0.0);
    place = rng.key.y % num_places(); // key.y counts the samples
    if (place == 0u) {
        group_entering = group_emitted = group_media = group_escaped = group_solid = vec3(0.0);
    }
    uvec4 bits = rng_next(rng);
    if (FROM_LIGHTS && place == AT_LIGHT) {
        follow_light(rng);
        measure = vec3(0.0);
        normal = vec3(0.0);
        origin = 2.0 * args.box_hi - args.box_lo; // and out of sight
        direction = vec3(0.0, 0.0, 1.0);
        heading = direction;
        heading_normal = vec3(0.0);
        heading_axis = direction;
        heading_pdf = 1.0;
        return;
    }
    if (SURFACES && place == ON_SURFACE) {
        origin = solid_point(bits, rng);
    } else if (SURFACES && place == ON_BOUNDARY) {
        origin = box_face_point(args.box_lo, args.box_hi, bits);
    } else if (place == ON_BOUNDARY) {
        origin = media_face_point(bits);
    } else {
        origin = volume_point(bits);
    }
    direction = heading_draw(origin, place == ON_SURFACE ? normal : vec3(0.0), rng);
}

// Of light that comes from `direction`: against the boundary's normal, or absorbed.
float outward_cosine(vec3 direction)
{
    float cosine = dot(direction, normal);
    return place == ON_BOUNDARY ? -cosine : place == ON_SURFACE ? max(cosine, 0.0) : 1.0;
}

void path_direct(vec3 direction, vec3 irradiance)
{
    if (FROM_LIGHTS && path_direct_light) {
        return;
    }
    float outwards = outward_cosine(direction);
    direct_in = measure * irradiance * max(-outwards, 0.0);
    direct_out = measure * irradiance * max(outwards, 0.0);
}

void add_value(uint i, float value, float share)
{
    float delta = value - partial.mean[i];
    partial.mean[i] += delta * share;
    partial.deviation[i] += delta * (value - partial.mean[i]);
}

// Samples of all kinds of points, one each, are one of the balance.
void add_group()
{
    vec3 sunlight = vec3(0.0);
    for (uint i = 0u; FROM_LIGHTS && i < args.num_lights; i++) {
        light_block light = light_get(i);
        sunlight += light.kind == TYN_LIGHT_KIND_DIRECTIONAL ? light.color * light_measure(light) : vec3(0.0);
    }
    vec3 shining = SURFACES && emitters.count > 0u ? emitters.power : vec3(0.0);
    partial.count++;
    float share = 1.0 / float(partial.count);
    for (uint c = 0u; c < 3u; c++) {
        float entering = group_entering[c] + sunlight[c], given = group_emitted[c] + shining[c];
        add_value(c, entering, share);
        add_value(3u + c, given, share);
        add_value(6u + c, group_media[c], share);
        add_value(9u + c, group_escaped[c], share);
        add_value(12u + c, group_solid[c], share);
        add_value(15u + c, entering + given - group_media[c] - group_escaped[c] - group_solid[c], share);
    }
}

void path_end(const path_result result)
{
    vec3 fluence = (result.radiance + result.background + result.reflected) / heading_pdf;
    float outwards = outward_cosine(heading);
    vec3 incoming = direct_in + measure * fluence * max(-outwards, 0.0);
    vec3 outgoing = direct_out + measure * fluence * max(outwards, 0.0);
    vec3 escapes = place == ON_BOUNDARY ? outgoing : place == ON_SURFACE ? sent_out * outgoing : light_escaped;
    vec3 stays = place == ON_SURFACE ? kept * outgoing : light_surfaces;
    group_entering += place == ON_BOUNDARY ? incoming : vec3(0.0);
    group_emitted += emitted;
    group_media += place == IN_MEDIA ? outgoing : light_media;
    group_escaped += escapes;
    group_solid += stays;
    if (place + 1u == num_places()) {
        add_group();
    }
}

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    path_load();
    if (thread >= args.slots) {
        return;
    }
    for (uint i = 0u; i < TYN_PATH_BALANCE_VALUES; i++) {
        partial.mean[i] = 0.0;
        partial.deviation[i] = 0.0;
    }
    partial.count = 0u;
    uint groups = args.num_samples / num_places();
    uint each = groups / args.slots, more = groups % args.slots;
    uint block = args.first, first = args.first_sample + num_places() * (thread * each + min(thread, more));
    if (first >= TYN_PATH_BALANCE_BLOCK) {
        block++;
        first -= TYN_PATH_BALANCE_BLOCK;
    }
    uint end = first + num_places() * (each + (thread < more ? 1u : 0u));
    if (end > TYN_PATH_BALANCE_BLOCK) {
        beyond = end - TYN_PATH_BALANCE_BLOCK;
        end = TYN_PATH_BALANCE_BLOCK;
    }
    path_run(block, first, end);
    partials[thread] = partial;
    path_tally(thread == 0u && path_count.hits > 0u ? 1u : 0u);
}
