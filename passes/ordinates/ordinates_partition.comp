// ordinates_partition.comp -- cuts the sphere into regions.
//
// One workgroup. A region for n ordinates is cut into two for n / 2 and n - n / 2 of them, in
// proportion, until every region has one: all ordinates then have about the same light x importance. With a fan these are
// regions of fan ordinates, each cut on until it has one.
// The axes of the cuts come from a first tree that ignores importance, so that nothing but the map can
// change them.
#include "shaders/light/ordinate_args.h"
#include "ordinates_args.h"
#include "shaders/light/sky_args.h"

layout(local_size_x = TYN_ORDINATES_MAX) in;
TYN_ARGS(ordinates_args args);
TYN_READ(0, sums, sky_sum sums[]);
TYN_READ(1, weights, float weights[]);
TYN_WRITE(2, regions, vec4 list[]); // from, to

#include "ordinates_cuts.glsl"

const uint LEVELS = 8u; // 2^8 = TYN_ORDINATES_MAX

// The tree as a heap: node i has the children 2 i and 2 i + 1.
shared ordinates_region regions[2 * TYN_ORDINATES_MAX];
shared uint leaves[2 * TYN_ORDINATES_MAX]; // below a node; 0: no node
shared uint first[2 * TYN_ORDINATES_MAX];  // of them
shared uint axes[TYN_ORDINATES_MAX];

void plant_tree()
{
    for (uint i = gl_LocalInvocationIndex; i < 2 * TYN_ORDINATES_MAX; i += TYN_ORDINATES_MAX) {
        leaves[i] = i == 1u ? args.regions : 0u;
        first[i] = 0u;
        regions[i] = ordinates_region(vec2(0.0), vec2(SKY_SUMS_WIDTH, SKY_SUMS_HEIGHT));
    }
    barrier();
}

uint lower_leaves(uint n)
{
    uint fans = n / args.fan;
    return fans > 1u ? fans / 2u * args.fan : n / 2u;
}

void divide_node(uint node, uint axis, float cut)
{
    const uint n = leaves[node], n_lower = lower_leaves(n);
    ordinates_divide(regions[node], axis, cut, regions[2u * node], regions[2u * node + 1u]);
    leaves[2u * node] = n_lower;
    leaves[2u * node + 1u] = n - n_lower;
    first[2u * node] = first[node];
    first[2u * node + 1u] = first[node] + n_lower;
}

// Where the threads have a node of this level: a loop of one round or none, which a device that
// follows both sides of every branch can leave out.
uint first_of_level(uint level)
{
    const uint me = gl_LocalInvocationIndex, node = (1u << level) + me;
    return me < 1u << level && leaves[node] > 1u ? node : 2 * TYN_ORDINATES_MAX;
}

float part_below(uint node)
{
    return float(lower_leaves(leaves[node])) / float(leaves[node]);
}

void grow_tree(const ordinates_density density)
{
    plant_tree();
    for (uint level = 0u; level < LEVELS; level++) {
        for (uint node = first_of_level(level); node < 2u << level; node += TYN_ORDINATES_MAX) {
            float cut;
            axes[node] = ordinates_axis(regions[node], part_below(node), density, cut);
            divide_node(node, axes[node], cut);
        }
        barrier();
    }
}

// Along the axes of the tree before.
void grow_tree_again(const ordinates_density density)
{
    plant_tree();
    for (uint level = 0u; level < LEVELS; level++) {
        for (uint node = first_of_level(level); node < 2u << level; node += TYN_ORDINATES_MAX) {
            divide_node(node, axes[node],
                        ordinates_cut(regions[node], axes[node], part_below(node), density));
        }
        barrier();
    }
}

// Per sr: `spread` times the mean of what is shared out.
ordinates_density density_of(uint table)
{
    float mean =
        ordinates_scalar((SKY_SUMS_HEIGHT + 1) * ORDINATES_ROW - 1u, table) / (4.0 * SKY_PI);
    return ordinates_density(table, mean > 0.0 ? args.spread * mean : 1.0);
}

void main()
{
    const uint me = gl_LocalInvocationIndex;
    const bool mapped = args.mapped != 0u && args.regions > 0u;
    grow_tree(density_of(mapped ? ORDINATES_SUMS : ORDINATES_NO_TABLE));
    if (args.weighted != 0u) {
        grow_tree_again(density_of(ORDINATES_WEIGHTS));
    }
    for (uint i = me; i < 2 * TYN_ORDINATES_MAX; i += TYN_ORDINATES_MAX) {
        if (leaves[i] == 1u) {
            list[first[i]] = vec4(regions[i].from, regions[i].to);
        }
    }
}
