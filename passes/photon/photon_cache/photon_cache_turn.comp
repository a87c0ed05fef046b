// photon_cache_turn.comp -- notes which generations the sum has.
#include "../common/photon_args.h"

layout(local_size_x = 1) in;
TYN_READ(0, ring, photon_ring ring; int words[]);
TYN_UPDATE(1, sum, photon_sum sum; int sums[]);

void main()
{
    sum.turns = ring.turns;
}
