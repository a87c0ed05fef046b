// gbuffer.glsl -- what pass gbuffer stores of the surface that a ray of the camera meets first.
//
// Three RGBA32F images of camera.size * samples texels, sample (i, j) of a pixel beside its neighbours:
// `surface`: shading normal, distance along the ray in m (0: no surface); `albedo`: albedo, x of the
// facet's normal; `emission`: radiance towards the camera, y of it. Normals are in M, on the camera's side.
//
// Where all samples of a pixel lie on one piece of surface, its first sample holds their mean normal, albedo and
// emission, and of the others there is the distance only. The pixels of several pieces are in a list.
#ifndef TYN_GBUFFER_GLSL
#define TYN_GBUFFER_GLSL

struct gbuffer_point {
    float distance; // m along the ray; 0: no surface
    vec3 normal;    // for shading
    vec3 facet;     // of the triangle
    vec3 albedo;
    vec3 emission; // W/(m^2 sr)
};

// The octahedral map of unit vectors to [-1, 1]^2 (Cigolle et al., "A survey of efficient representations
// for independent unit vectors", JCGT 3(2), 2014).
vec2 gbuffer_fold(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 signs = mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * signs;
}

vec3 gbuffer_unfold(vec2 p)
{
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    vec2 signs = mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    n.xy = n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * signs;
    return normalize(n);
}

void gbuffer_pack(gbuffer_point p, out vec4 surface, out vec4 albedo, out vec4 emission)
{
    vec2 facet = gbuffer_fold(p.facet);
    surface = vec4(p.normal, p.distance);
    albedo = vec4(p.albedo, facet.x);
    emission = vec4(p.emission, facet.y);
}

// The facet's y is within -1 to 1; of a pixel's first sample it tells what the pixel shows.
#define GBUFFER_WHOLE 4.0 // added: one piece of surface
#define GBUFFER_NONE 8.0  // instead: none

bool gbuffer_whole(vec4 emission)
{
    return emission.w > 2.0 && emission.w < 6.0;
}

bool gbuffer_none(vec4 emission)
{
    return emission.w > 6.0;
}

// Do a sample at `other` (M) with the normal `facet`, in the distance `distance` from the camera, and one at `first`
// lie on one piece of surface?
bool gbuffer_same(gbuffer_point first, vec3 at, vec3 facet, vec3 other, float distance)
{
    vec3 d = other - at;
    return dot(facet, first.facet) > 0.9 && abs(dot(d, first.facet)) < 0.3 * length(d) + 1e-5 * distance;
}

gbuffer_point gbuffer_unpack(vec4 surface, vec4 albedo, vec4 emission)
{
    return gbuffer_point(surface.w, surface.xyz, gbuffer_unfold(vec2(albedo.w, emission.w - (gbuffer_whole(emission) ? GBUFFER_WHOLE : 0.0))),
                         albedo.rgb, emission.rgb);
}

#endif
