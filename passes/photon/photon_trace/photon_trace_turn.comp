// photon_trace_turn.comp -- which generations are traced in this frame, and how many workgroups that takes.
#include "photon_trace_args.h"
#include "../common/photon_args.h"

layout(local_size_x = 1) in;
TYN_ARGS(photon_turn_args args);
TYN_UPDATE(0, ring, photon_ring ring; int words[]);
TYN_WRITE(1, groups, uvec3 groups[]);

void main()
{
    uint count = ring.turns == 0u ? args.all : args.each;
    ring.first = ring.turns;
    ring.count = count;
    ring.turns += count;
    uint left = count * args.photons, own = PHOTON_TRACE_GROUP * PHOTON_TRACE_EACH;
    for (uint i = 0u; i < args.dispatches; i++) {
        uint batch = min(left, args.batch);
        groups[i] = uvec3((batch + own - 1u) / own, 1u, 1u);
        left -= batch;
    }
}
