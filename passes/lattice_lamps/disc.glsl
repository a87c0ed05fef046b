// disc.glsl -- what a Lambertian disc sends to a point of a medium. No bindings.

struct disc_light {
    float fluence; // of the intensity along the disc's normal, 1/m^2
    vec3 mean;     // net flux over fluence
};

// A disc of radius R and intensity 1 at a point that is h before its plane and r away from its centre. The flux through a plane
// parallel to it is exact (docs/surfaces.md, "Virtual point lights"). The mean direction m is the mean of that from the disc's
// nearest point and of the way from its centre, which sqrt(r^2 + R^2) makes shorter than 1: half the normal where h = 0 in front
// of the disc, along the way far off, exact on the axis. So is the fluence, flux / (m . n); elsewhere it is within 14 %.
disc_light disc_light_at(vec3 away, vec3 normal, float radius)
{
    float h = dot(away, normal), r2 = dot(away, away), square = radius * radius;
    if (h <= 0.0) {
        return disc_light(0.0, vec3(0.0));
    }
    float s = sqrt((r2 - square) * (r2 - square) + 4.0 * square * h * h);
    float flux = r2 > square ? 2.0 * h * h / (s * (s + r2 - square)) : (s + square - r2) / (2.0 * s * square);
    vec3 across = away - h * normal;
    vec3 nearest = h * normal + max(1.0 - radius * inversesqrt(max(dot(across, across), 1e-36)), 0.0) * across;
    vec3 mean = 0.5 * (away * inversesqrt(r2 + square) + normalize(nearest));
    return disc_light(flux / dot(mean, normal), mean);
}
