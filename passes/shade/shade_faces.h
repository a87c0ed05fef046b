// shade_faces.h -- the light that leaves the medium's box, as an image. Included by C and GLSL.
//
// RGBA32F. Each of the six faces of the lattice (-x, +x, -y, +y, -z, +z) is a row; along it are its patches: the whole,
// then 2 x 2 of them, SHADE_FACE_ENTRIES texels each. Below are tiles of the light of 4 x 4 patches, face beside face,
// to interpolate in. A patch shines as what of it is lit: the rectangle around those of its cells that have light and
// no wall outwards.

#define SHADE_FACE_SIDE 4 // patches along each side of a face, at most
#define SHADE_FACE_PATCHES (1 + 4 + 16)
// Texels of a record:
// from and to along the two other axes, in axis order (M, m)
#define SHADE_FACE_RECT 0
// radiance into all directions that carries the patch's net flux (may be negative: the box takes light of the sky);
// what is not 0: there is any
#define SHADE_FACE_LIGHT 1
// radiance into the direction w over that: max(x + dot(yzw, w), 0)
#define SHADE_FACE_SHAPE 2
// the middle of a lit cell (M, m), as near to the patch's as there is
#define SHADE_FACE_AIM 3
#define SHADE_FACE_ENTRIES 4
#define SHADE_FACE_WIDTH 24 // texels: the larger of the records and of the tiles of six faces

// What surfaces leave of the view of the faces: RGBA32F, on a grid of places (struct shade_args). Six fields, one a
// face, are behind each other along z: which of its 2 x 2 patches are seen from there. One more: 0 at places that see
// none of the box, as within solids, which are left out where others are near.
#define SHADE_SIGHT_SHARE 6
#define SHADE_SIGHT_FIELDS 7
