// shade_tent.glsl -- sums over the pattern of shade_vpls.comp, along a row or a column. Before it: SHADE_TENT_IMAGE, the name of a
// uimage2D of shade_part.glsl's texels; `camera`; `shade_side`.
//
// Every place of the pattern is met once in `shade_side` blocks. Between two blocks of one place the light of
// its VPLs is taken to be linear: the two nearest count in proportion to how near they are. (The nearest alone would
// show as squares wherever one VPL is much of the light.) Of the two, blocks of other surfaces do not count.
#extension GL_EXT_control_flow_attributes : require

// The sum at `block`, whose own part is `here`; `step` to its neighbours. Not whole where most places of the pattern
// have no block on this surface nearby.
shade_part shade_tent(ivec2 block, ivec2 step, const shade_part here)
{
    // How far a neighbour d steps off is from the facet's plane: a d + b (z' - z) + c z' d, z along the axis.
    vec2 size = camera_whole(camera) / float(shade_step);
    vec3 move = 2.0 * (float(step.x) / size.x * camera.half_width * camera.right - float(step.y) / size.y * camera.half_height * camera.up);
    camera_ray ray = camera_ray_through(camera, shade_middle(block));
    float width = 2.0 * camera.half_height / size.y * camera_select(camera, 1.0, here.along), per = 1.0 / max(width, 1e-30);
    float along = dot(here.facet, move);
    float a = camera_select(camera, along, 0.0) * per, c = camera_select(camera, 0.0, along) * per;
    float b = dot(here.facet, ray.direction) / dot(ray.direction, camera.forward) * per;
    ivec2 last = shade_blocks() - 1;
    shade_part sum = here;
    int met = 1;
    [[unroll]] for (int k = 1; k < shade_side; k++) {
        vec4 mean = vec4(0.0);
        float sides = 1.0;
        [[unroll]] for (int i = 0; i < 2; i++) {
            int d = i == 0 ? k : k - shade_side;
            ivec2 at = block + d * step, held = clamp(at, ivec2(0), last);
            shade_part there = shade_unpack(imageLoad(SHADE_TENT_IMAGE, held));
            // Neighbours may be as far off the plane as the block is wide, and turned by 26 degrees (docs/measurements.md,
            // "Constants"). Those that are a bit worse count where there are no others.
            float off = abs(float(d) * (a + c * there.along) + b * (there.along - here.along));
            float turned = dot(here.facet, there.facet), like = clamp(2.0 - off, 0.0, 1.0) * smoothstep(0.7, 0.9, turned);
            like = max(like, off < 6.0 && turned > 0.5 ? 0.01 : 0.0);
            bool counts = at == held && there.along > 0.0 && there.whole;
            sides *= counts ? like : 0.0;
            bool tells = counts && like > 0.1;
            sum.near = sum.near || tells && there.near;
            sum.aside = sum.aside || tells && there.aside;
            mean += (counts ? like * (1.0 - float(abs(d)) / float(shade_side)) : 0.0) * vec4(there.irradiance, 1.0);
        }
        sum.irradiance += mean.rgb / max(mean.a, 1e-6);
        met += mean.a > 1e-3 ? 1 : 0;
        sum.aside = sum.aside || sides < 0.01;
    }
    // Any place of the pattern takes VPLs from everywhere, so most stand for all.
    sum.irradiance *= float(shade_side) / float(met);
    sum.whole = here.whole && 2 * met > shade_side;
    return sum;
}
