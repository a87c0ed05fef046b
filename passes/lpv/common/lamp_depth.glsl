// lamp_depth.glsl -- what the medium leaves of the light of a sun or lamp, by its index among the shadow maps.
//
// Include after beam.glsl, radial.glsl with RADIALS_TEXELS, and shadow_args.h, in workgroups of 64 threads or more.

shared uint lamp_depth_grid;

// The grid of a lamp: those are in another order than the maps. By all threads of a workgroup, for the same light.
uint lamp_grid_of(uint light)
{
    uint lane = gl_LocalInvocationIndex;
    if (light >= TYN_SHADOW_SUNS && lane < min(texelFetch(radials_texels, 0).y, TYN_SHADOW_LAMPS) &&
        radial_grid_of(lane).light.shadow == light) {
        lamp_depth_grid = lane;
    }
    barrier();
    return light < TYN_SHADOW_SUNS ? 0u : lamp_depth_grid;
}

// Light scattered forward counts as not scattered. `grid` of lamp_grid_of.
vec3 lamp_transmittance(uint light, uint grid, vec3 p)
{
    beam_tau tau;
    if (light < TYN_SHADOW_SUNS) {
        tau = beam_depth(light, p);
    } else {
        radial_grid lamp = radial_grid_of(grid);
        vec3 away = clamp(p, vec3(0.0), medium.extent) - lamp.light.position;
        tau = radial_tau(radial_place_in(lamp, away, length(away)));
    }
    return exp(-(tau.a + tau.p));
}
