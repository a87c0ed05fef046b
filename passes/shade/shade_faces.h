// shade_faces.h -- the light that leaves the medium's box, as an image. Included by C and GLSL.
//
// RGBA32F. Each of the six faces of the lattice (-x, +x, -y, +y, -z, +z) is a row; along it are its patches: the whole,
// then 2 x 2, then 4 x 4 of them, SHADE_FACE_ENTRIES texels each. A patch shines as what of it is lit: the rectangle around those of its cells that have
// light and no wall outwards.
#ifndef SHADE_FACES_H
#define SHADE_FACES_H

#define SHADE_FACE_SIDE 4 // patches along each side of a face, at most
#define SHADE_FACE_PATCHES (1 + 4 + 16)
#define SHADE_FACE_RECT 0 // from and to along the two other axes, in axis order (M, m)
#define SHADE_FACE_LIGHT 1 // radiance into all directions that carries the patch's net flux (may be negative: the box
                           // takes light of the sky); what is not 0: there is any
#define SHADE_FACE_SHAPE 2 // radiance into the direction w over that: max(x + dot(yzw, w), 0)
#define SHADE_FACE_ENTRIES 3

// What surfaces leave of the view of a whole face and of its 2 x 2 patches: R32F, maps of distances as VPLs have them
// (vpl_visibility.glsl), faces as rows.
#define SHADE_FACE_MAPS 5
#define SHADE_FACE_TEXELS 16

#endif
