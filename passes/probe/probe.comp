// probe.comp -- fluence and net flux at points: the lattice's moments and what is left of the suns.
#include "probe_args.h"
#include "probe_local.h"
#include "shaders/light/ordinate_args.h"
#include "shaders/common/counters.h"
#define MEDIUM_BLOCK 0
#define BEAMS_AT 3
#define BEAMS_STORAGE
#define COLUMNS_AT 10
#define RADIALS_AT 14
#define RADIALS_STORAGE
#include "shaders/medium/medium.glsl"
#include "shaders/beams/beam.glsl"
#include "shaders/beams/columns.glsl"
#include "shaders/beams/radial.glsl"
#include "shaders/lattice/lattice.glsl"
#define WALLS_AT 12
#define WALLS_STORAGE
#include "shaders/walls/lattice_walls.glsl"
#define SHADOWS_AT 18
#define SHADOWS_STORAGE
#include "shaders/light/shadow.glsl"
#define VPL_DISTANCES 21
#define LATTICE_ROOMS 22
#include "shaders/light/vpl_visibility.glsl"
#include "shaders/walls/lattice_rooms.glsl"

layout(constant_id = 1) const uint walls = 0;
layout(constant_id = 2) const uint shadowed = 0;
layout(constant_id = 3) const uint mapped = 0; // what virtual point lights (VPLs) see
layout(constant_id = 4) const uint rooms = 0;  // and where they shine
layout(local_size_x = 64) in;
TYN_ARGS(probe_args args);
TYN_READ(1, lights, light_block lights[]);
layout(binding = 2) uniform sampler3D moments;
layout(binding = 20) uniform sampler3D cells;
TYN_UNIFORM(9, environment, env_block environment);
TYN_READ(7, points, vec3 points[]);
TYN_WRITE(8, results, probe_result results[]);
TYN_UPDATE(23, counters, counters_block counters);

// A point between the centres of eight cells; beyond the outermost ones the same line goes on.
struct cell_corners {
    ivec3 lo, hi;
    vec3 t;
};

cell_corners corners_of(const lattice_box box, vec3 p)
{
    vec3 x = clamp(lattice_from_m(box, p), vec3(0.0), vec3(box.dims)) - 0.5;
    ivec3 lo = clamp(ivec3(floor(x)), ivec3(0), max(box.dims - 2, 0));
    cell_corners corners = cell_corners(lo, min(lo + 1, box.dims - 1), x - vec3(lo));
    for (int axis = 0; axis < 3; axis++) {
        if (medium.repeat[axis] != 0u) {
            int n = box.dims[axis], i = int(floor(x[axis]));
            corners.lo[axis] = (i + n) % n;
            corners.hi[axis] = (i + 1) % n;
            corners.t[axis] = x[axis] - floor(x[axis]);
        }
    }
    return corners;
}

ivec3 corner_of(const cell_corners c, uint corner, out float weight)
{
    bvec3 far = bvec3((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
    vec3 w = mix(1.0 - c.t, c.t, far);
    weight = w.x * w.y * w.z;
    return ivec3(far.x ? c.hi.x : c.lo.x, far.y ? c.hi.y : c.lo.y, far.z ? c.hi.z : c.lo.z);
}

vec4 moments_at(const lattice_box box, vec3 p, uint ch)
{
    if (walls == 1) {
        walls_place place = walls_place_of(box, p);
        if (walls_near(place)) {
            return walls_fetch(moments, box, walls_blend_of(box, place, p), ivec3(0, 0, int(ch) * box.dims.z));
        }
    }
    cell_corners corners = corners_of(box, p);
    vec4 sum = vec4(0.0);
    for (uint i = 0; i < 8; i++) {
        float w;
        ivec3 c = corner_of(corners, i, w);
        sum += w * texelFetch(moments, c + ivec3(0, 0, int(ch) * box.dims.z), 0);
    }
    return sum;
}

// Mean of e^-tau over a cell between whose ends tau is linear.
vec3 mean_of(vec3 tau0, vec3 tau1)
{
    vec3 x = tau1 - tau0;
    vec3 mean = (exp(-tau0) - exp(-tau1)) / mix(x, vec3(1.0), lessThan(abs(x), vec3(1e-3)));
    return mix(mean, exp(-0.5 * (tau0 + tau1)), lessThan(abs(x), vec3(1e-3)));
}

// In the outer half of the outermost cells moments go on as a line. Next to a lit face the
// scattered flux does not: what it gains is what sunlight loses in first scatterings, e^-tau over a
// fraction of a cell. The line through two cells' means is that of their sum, which changes little.
// So this adds what the line has of sunlight, less the sunlight at p, per unit of its irradiance:
// as much as of its losses is scattered.
vec3 sunlight_in_line(const lattice_box box, uint sun, vec3 p)
{
    vec3 x = lattice_from_m(box, p), sum = vec3(0.0);
    if (args.cells == 0u || any(lessThan(x, vec3(0.0))) || any(greaterThan(x, vec3(box.dims)))) {
        return sum;
    }
    ivec3 c = clamp(ivec3(floor(x)), ivec3(0), box.dims - 1);
    vec3 albedo;
    for (uint ch = 0; ch < 3; ch++) {
        vec4 cell = texelFetch(cells, c + ivec3(0, 0, int(args.channels == 1 ? 0 : ch) * box.dims.z), 0);
        albedo[ch] = cell.x / max(cell.x + cell.y, 1e-30);
    }
    beam_tau here = beam_depth(sun, p);
    for (int axis = 0; axis < 3; axis++) {
        bool first = x[axis] < 0.5, last = x[axis] > float(box.dims[axis]) - 0.5;
        if (!(first || last) || medium.repeat[axis] != 0u || box.dims[axis] < 2) {
            continue;
        }
        float depth = first ? x[axis] : float(box.dims[axis]) - x[axis];
        vec3 tau[3]; // at the ends of the two cells
        for (int k = 0; k < 3; k++) {
            vec3 q = x;
            q[axis] = first ? float(k) : float(box.dims[axis] - k);
            beam_tau at = beam_depth(sun, lattice_to_m(box, q));
            tau[k] = at.a + at.p;
        }
        vec3 line = mix(mean_of(tau[0], tau[1]), mean_of(tau[1], tau[2]), depth - 0.5);
        sum += albedo * (line - exp(-(here.a + here.p)));
    }
    return sum;
}

beam_tau ordinate_tau(const lattice_box box, vec3 p, uint n)
{
    cell_corners corners = corners_of(box, p);
    beam_tau sum = beam_tau(vec3(0.0), vec3(0.0), vec3(0.0));
    for (uint i = 0; i < 8; i++) {
        float w;
        ivec3 c = corner_of(corners, i, w);
        beam_tau tau = columns_tau(n, uvec3(c), uvec3(box.dims));
        sum.s += w * tau.s;
        sum.a += w * tau.a;
        sum.p += w * tau.p;
    }
    vec3 zero = vec3(0.0);
    return beam_tau(max(sum.s, zero), max(sum.a, zero), max(sum.p, zero));
}

// Where light along `direction` that arrives at p was last in the box: p itself if that is inside.
// False: it never was.
bool last_in_box(vec3 p, vec3 direction, out vec3 last)
{
    vec3 d = mix(direction, vec3(1e-12), lessThan(abs(direction), vec3(1e-12)));
    vec3 endless = 1e30 * vec3(medium.repeat);
    vec3 t0 = (p + endless) / d, t1 = (p - medium.extent - endless) / d; // distances back to the faces
    vec3 lo = min(t0, t1), hi = max(t0, t1);
    float t = max(max(max(lo.x, lo.y), lo.z), 0.0);
    last = p - t * d;
    return t <= min(min(hi.x, hi.y), hi.z);
}

// Optical depth between local light n and p, which lies `away` from it and may be outside of the box.
beam_tau lamp_tau(uint n, vec3 away)
{
    vec3 o = radials[n].light.position;
    vec3 d = mix(away, vec3(1e-20), lessThan(abs(away), vec3(1e-20)));
    vec3 t0 = -o / d, t1 = (medium.extent - o) / d, lo = min(t0, t1), hi = max(t0, t1);
    float enter = max(max(lo.x, lo.y), lo.z), leave = min(min(hi.x, hi.y), min(hi.z, 1.0));
    if (enter >= leave || leave <= 0.0) {
        return beam_tau(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    vec3 last = leave * away;
    return radial_tau(radial_place_of(n, last, length(last)));
}

// The cell that stands for p: its own, or the one on p's side of walls that has most to say of it.
ivec3 cell_for(const lattice_box box, const walls_place place, vec3 p)
{
    ivec3 cell = place.cell;
    if (walls_near(place)) {
        walls_blend b = walls_blend_of(box, place, p);
        float most = 0.0;
        for (uint i = 0; i < 8; i++) {
            cell = b.share[i] > most ? walls_corner(b, i) : cell;
            most = max(most, b.share[i]);
        }
        cell = b.instead.x >= 0 ? b.instead : cell;
    }
    return cell;
}

// Share of a VPL's light that surfaces let through to p. Its map is coarse, and the edge of a body that stands towards
// the VPL may pass between its rays: unless all of them go on far beyond p, and no wall at p parts it from the VPL, the
// lattice is asked, too, which no light leaks through.
float vpl_share(const lattice_box box, uint n, vec3 p, vec3 away, float r)
{
    vec3 position = radials[n].light.position, axis = radials[n].light.direction;
    vpl_map map = vpl_map_of(n - radial_num_lamps, axis);
    walls_place place = walls_place_of(box, p);
    walls_planes planes = walls_planes_of(place.index);
    bool parted = walls_behind(planes, position) != walls_behind(planes, p);
    float share = vpl_map_visibility(map, away, r, parted);
    if (share > 0.0) {
        ivec3 from = walls_cell_before(box, position, axis), cell = cell_for(box, place, p);
        uint vpl = n - radial_num_lamps;
        bool before = true; // a cell of the VPL's own room is before it
        if (rooms == 1) {
            before = rooms_cell_before(box.dims, vpl, from);
            share = rooms_joined(rooms_of_vpl(box.dims, vpl), rooms_of_cell(box.dims, cell)) ? share : 0.0;
        }
        if (parted || vpl_map_visibility(map, away, 2.0 * r, true) < 1.0) {
            share = before && walls_visible(box, cell, from) ? share : 0.0;
        }
    }
    return share;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= args.num_points) {
        return;
    }
    vec3 p = medium_wrap(points[i]);
    ivec3 dims = textureSize(moments, 0);
    dims.z /= int(args.channels);
    lattice_box box = lattice_box_of(medium.extent, dims);
    vec4 field[3];
    for (uint ch = 0; ch < 3; ch++) {
        field[ch] = args.tint[ch] * moments_at(box, p, args.channels == 1 ? 0 : ch);
    }
    vec4 of_lattice = field[0] + field[1] + field[2];
    // Next to walls moments are not taken along lines.
    bool near_wall = walls == 1 && walls_near(walls_place_of(box, p));
    for (uint sun = 0; sun < args.num_suns; sun++) {
        vec3 last;
        beam_tau tau = beam_tau(vec3(0.0), vec3(0.0), vec3(0.0));
        if (last_in_box(p, lights[sun].direction, last)) {
            tau = beam_depth(sun, last);
        }
        // The lattice counts light in the forward peak as not scattered; a probe of the scattered
        // light takes it back.
        vec3 e = exp(-(tau.a + tau.p));
        if (args.scattered_only != 0) {
            e -= exp(-(tau.a + tau.s));
        }
        if (shadowed == 1) {
            e *= shadow_visibility_sun(sun, p);
        }
        vec3 flux = lights[sun].mean_cosine * lights[sun].direction;
        vec3 beyond = near_wall ? vec3(0.0) : sunlight_in_line(box, sun, p);
        for (uint ch = 0; ch < 3; ch++) {
            field[ch].yzw += beyond[ch] * lights[sun].color[ch] * flux;
            field[ch] += e[ch] * lights[sun].color[ch] * vec4(1.0, flux);
        }
    }
    uint lights = args.local_lights == TYN_PROBE_LOCAL_ALL     ? radial_count
                  : args.local_lights == TYN_PROBE_LOCAL_LAMPS ? radial_num_lamps
                                                           : 0u;
    for (uint n = 0; n < lights; n++) {
        vec3 away = p - radials[n].light.position;
        float r = length(away), radius = radials[n].light.radius;
        float share = radial_share(n, away, r) / max(r * r, max(radius * radius, 1e-13 * dot(medium.extent, medium.extent)));
        if (share <= 0.0) {
            continue;
        }
        beam_tau tau = lamp_tau(n, away);
        vec3 e = exp(-(tau.a + tau.p));
        if (args.scattered_only != 0) {
            e -= exp(-(tau.a + tau.s));
        }
        if (shadowed == 1 && radials[n].light.shadow != TYN_LIGHT_NO_SHADOW) {
            e *= shadow_visibility_lamp(radials[n].light.shadow, p);
        }
        if (walls == 1 && mapped == 1 && n >= radial_num_lamps) {
            e *= vpl_share(box, n, p, away, r);
        }
        e *= share * radials[n].light.color;
        for (uint ch = 0; ch < 3; ch++) {
            field[ch] += e[ch] * vec4(1.0, away / max(r, 1e-20));
        }
    }
    uint count = min(ordinates.count, args.num_ordinates);
    for (uint n = 0; n < count; n++) {
        vec3 last, d = ordinates.list[n].direction, color = ordinates.list[n].irradiance;
        beam_tau tau = beam_tau(vec3(0.0), vec3(0.0), vec3(0.0));
        if (last_in_box(p, d, last)) {
            tau = ordinate_tau(box, last, n);
        }
        vec3 direct = exp(-(tau.a + tau.s)), e = color * exp(-(tau.a + tau.p));
        if (args.scattered_only != 0) {
            // The mean of the sky that comes from the regions is in the moments.
            vec4 even = vec4(ordinates.list[n].even, ordinates.list[n].even_flux);
            e -= direct * color;
            for (uint ch = 0; ch < 3; ch++) {
                field[ch] -= direct[ch] * environment.sky[ch] * even;
            }
        }
        d *= ordinates.list[n].mean_cosine;
        for (uint ch = 0; ch < 3; ch++) {
            field[ch] += e[ch] * vec4(1.0, d);
        }
    }
    if (args.parts != 0) {
        vec4 all = field[0] + field[1] + field[2];
        field = vec4[3](of_lattice / 3.0, (all - of_lattice) / 3.0, vec4(0.0));
    }
    for (uint ch = 0; ch < 3; ch++) {
        if (any(isnan(field[ch])) || any(isinf(field[ch]))) {
            field[ch] = vec4(0.0);
            atomicAdd(counters.non_finite, 1u);
        }
        if (field[ch].x < 0.0) {
            field[ch].x = 0.0;
            atomicAdd(counters.clamped, 1u);
        }
        results[i].fluence[ch] = field[ch].x;
        results[i].fluence_se[ch] = 0.0;
        for (uint axis = 0; axis < 3; axis++) {
            results[i].flux[3 * axis + ch] = dot(args.world[axis], field[ch].yzw);
            results[i].flux_se[3 * axis + ch] = 0.0;
        }
    }
}
