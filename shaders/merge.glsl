// merge.glsl -- what a cell of the lattice scatters towards the eye.
//
// Include after lattice.glsl, with the bindings medium, camera, cells, moments and inscatter; define
// MERGE_CHANNELS, 1 or 3.
#ifndef TYN_MERGE_GLSL
#define TYN_MERGE_GLSL

// The field is linear in direction: (phi + 3 g' v.F) / 4 pi, v towards the eye.
vec4 merge_towards_eye(lattice_box box, ivec3 c)
{
    vec3 p = lattice_to_m(box, vec3(c) + 0.5), v = camera.origin - p;
    v = camera.orthographic != 0 ? -camera.forward : v / max(length(v), 1e-20);
    vec4 j = vec4(0.0);
    for (int ch = 0; ch < MERGE_CHANNELS; ch++) {
        ivec3 texel = c + ivec3(0, 0, ch * box.dims.z);
        vec4 m = texelFetch(moments, texel, 0);
        j[ch] = max(m.x + 3.0 * texelFetch(cells, texel, 0).z * dot(v, m.yzw), 0.0) / 12.56637061;
    }
    return j;
}

// A ghost cell continues the two cells before it: 2 J_0 - J_1, along each axis where it is outside.
void merge_texel(ivec3 texel)
{
    ivec3 dims = imageSize(inscatter) - 2;
    if (any(greaterThanEqual(texel, dims + 2))) {
        return;
    }
    lattice_box box = lattice_box_of(medium.extent, dims);
    ivec3 c = texel - 1, near = clamp(c, ivec3(0), dims - 1);
    ivec3 far = clamp(2 * near - c, ivec3(0), dims - 1);
    ivec3 outside = ivec3(notEqual(c, near));
    vec4 j = vec4(0.0);
    for (int k = 0; k <= outside.z; k++) {
        for (int l = 0; l <= outside.y; l++) {
            for (int i = 0; i <= outside.x; i++) {
                ivec3 q = ivec3(i == 0 ? near.x : far.x, l == 0 ? near.y : far.y, k == 0 ? near.z : far.z);
                float w = (i == 0 ? 1.0 + outside.x : -1.0) * (l == 0 ? 1.0 + outside.y : -1.0) *
                          (k == 0 ? 1.0 + outside.z : -1.0);
                j += w * merge_towards_eye(box, q);
            }
        }
    }
    imageStore(inscatter, texel, vec4(max(j.rgb, vec3(0.0)), 1.0));
}

#endif
