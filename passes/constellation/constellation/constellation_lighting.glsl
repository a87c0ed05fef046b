// constellation_lighting.glsl -- the light that a sample scatters towards the eye: the sum over lights of Program 1.
//
// Include after constellation_medium.glsl, camera.glsl, shadow.glsl and light_list.glsl.

const float CONSTELLATION_DARK = 20.0; // optical depth behind which a light is not followed: e^-20 = 2e-9
const int CONSTELLATION_AT_ONCE = 2;   // steps of a shadow ray in a turn of its loop
const float CONSTELLATION_INV_4_PI = 0.0795774715;

// Transmittance from p, at most `reach` metres towards a light: samples in the middle of steps as long as slices are
// apart; empty steps are left out where the distance map says so, whole ones only, so that nothing changes.
vec3 transmittance_towards(vec3 p, vec3 towards, float reach)
{
    const float step = args.slices.distance;
    // Rounding may have put a sample on a face of the box, along which a light may shine, or beyond it.
    p = clamp(p, 1e-6 * medium.extent, (1.0 - 1e-6) * medium.extent);
    const float end = min(ray_box(p, ray_inverse(towards), vec3(0.0), medium.extent).y, reach);
    const vec3 uvw = p / medium.extent, along = towards / medium.extent;
    const int count = int(ceil(end / step));
    const vec3 unit = extinction_of(MATTER(1.0));
    const float least = max(min(min(unit.r, unit.g), unit.b), 1e-30);
    MATTER sum = MATTER(0.0);
    int j = 0;
    while (j < count && least * most_of(sum) < CONSTELLATION_DARK) {
        [[unroll]] for (int k = 0; k < CONSTELLATION_AT_ONCE; k++) {
            const float from = float(j) * step, ds = clamp(end - from, 0.0, step);
            const vec4 v = textureLod(voxels_tex, uvw + (from + 0.5 * ds) * along, 0.0);
            sum += ds * matter_of(v);
            j += constellation_has(CONSTELLATION_DISTANCE) ? 1 + slices_skipped(args.slices, away_of(v)) : 1;
        }
    }
    return exp(-extinction_of(sum));
}

// Radiance per metre and sigma_s that the light sends towards the eye from p; `view`: the direction of the camera's ray.
vec3 scattered_of_light(const listed_light l, vec3 p, vec3 view, const sample_point s)
{
    vec3 towards = -l.direction, color = l.color;
    float reach = 3.4e38;
    if (constellation_has(CONSTELLATION_LAMPS) && l.kind != TYN_LIGHT_KIND_DIRECTIONAL) {
        const vec3 way = l.position - p;
        // Nearer than half a slice the sample stands for places that are farther away.
        const float r2 = dot(way, way), least = 0.5 * args.slices.distance;
        reach = sqrt(r2);
        towards = way / max(reach, 1e-20);
        color *= listed_light_lobe(l, -towards) / max(r2, least * least);
    }
    if (constellation_has(CONSTELLATION_SHADOWS) && l.shadow != TYN_LIGHT_NO_SHADOW) {
        color *= shadow_visibility(l.shadow, p);
    }
    // Light travels along -towards before and along -view after.
    const vec3 apart = towards - view;
    const float one_minus_mu = 0.5 * dot(apart, apart);
    vec3 scattered;
    [[unroll]] for (int c = 0; c < 3; c++) {
        scattered[c] = phase_near(s.phase[c], l.mean_cosine, one_minus_mu);
    }
    if (constellation_lighting == CONSTELLATION_SHADOWED) {
        scattered *= transmittance_towards(p, towards, reach);
    }
    return color * scattered;
}

// Of the dispatch's lights.
vec3 scattered_light(vec3 p, vec3 view, const sample_point s)
{
    const uvec4 head = texelFetch(light_list_texels, 0);
    vec3 sum = vec3(0.0);
    if (constellation_lighting == CONSTELLATION_ALPHA) {
        sum = uintBitsToFloat(head.yzw); // the mean radiance from all around
    } else {
        const uint end = min(head.x, args.light_end);
        for (uint n = args.light_begin; n < end; n++) {
            sum += scattered_of_light(listed_light_of(n), p, view, s);
        }
    }
    return args.scale * sum;
}
