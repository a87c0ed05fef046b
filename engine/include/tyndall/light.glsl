// light.glsl -- a host's surfaces and particles in the light of the medium. Made for GLSL 4.50 and later.
//
// The three images are tyn_frame.light, sampled with linear filtering and clamped at the edges (repeated along axes on which
// the medium does); the matrix is that of tyn_context_light. The radiance that travels along w at a place is taken to be
// (fluence + 3 dot(w, flux)) / (4 pi), W/(m^2 sr). Outside of the media's box its nearest face stands for the light.
#ifndef TYNDALL_LIGHT_GLSL
#define TYNDALL_LIGHT_GLSL

struct tyn_light {
    vec3 fluence;              // red, green, blue, W/m^2
    vec3 red, green, blue;     // net flux of each along the world's axes, W/m^2
};

tyn_light tyn_light_at(sampler3D red, sampler3D green, sampler3D blue, mat4 world_to_texture, vec3 world)
{
    vec3 at = (world_to_texture * vec4(world, 1.0)).xyz;
    vec4 r = textureLod(red, at, 0.0), g = textureLod(green, at, 0.0), b = textureLod(blue, at, 0.0);
    return tyn_light(vec3(r.x, g.x, b.x), r.yzw, g.yzw, b.yzw);
}

// Irradiance on the front of a surface with the unit normal n, W/m^2; times albedo / pi it is the radiance of a diffuse one.
// Of the radiance above, the integral of dot(-w, n) over all w that meet the front.
vec3 tyn_light_irradiance(const tyn_light light, vec3 n)
{
    vec3 along = vec3(dot(light.red, n), dot(light.green, n), dot(light.blue, n));
    return max(0.25 * light.fluence - 0.5 * along, vec3(0.0));
}

// What a particle with a Henyey-Greenstein lobe of mean cosine g in [-1, 1] scatters into the unit direction v (towards the
// eye), per unit of its scattering cross-section, W/(m^2 sr): times albedo and the share of a pixel that it covers it is
// what the pixel receives; times sigma_s and a length, what that length of a medium sends.
vec3 tyn_light_inscatter(const tyn_light light, float g, vec3 v)
{
    vec3 along = vec3(dot(light.red, v), dot(light.green, v), dot(light.blue, v));
    return max(light.fluence + 3.0 * g * along, vec3(0.0)) * 0.0795774715; // 1 / (4 pi)
}

#endif
