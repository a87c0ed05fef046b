// propagate_rect_next.comp -- is the next iteration of a batch still needed? Not where no cell was as bright as the threshold
// after the one before, nor behind one that was not needed: nothing was as bright as that. One thread.
#include "../common/propagate.glsl"
#include "propagate_rect_args.h"

layout(local_size_x = 1) in;
TYN_UPDATE(0, flight, uint flight[]);
TYN_WRITE(1, launches, propagate_launches launches);
TYN_ARGS(propagate_rect_args args);

void main()
{
    float before = args.iteration < 2u
                       ? 3e38
                       : uintBitsToFloat(flight[propagate_flight_word(args.flight, args.iteration - 1u)]);
    uint across = propagate_groups(args.cells, PROPAGATE_RECT_GROUP);
    uint along = propagate_groups(args.along, PROPAGATE_RECT_GROUP);
    uvec3 all = uvec3(across, across, along * args.count * args.channels);
    if (before < args.threshold * uintBitsToFloat(flight[PROPAGATE_FLIGHT_BRIGHTEST])) {
        launches.step = uvec3(0u);
    } else {
        launches.step = all;
        launches.copy = (args.iterations - args.iteration) % 2u == 0u ? uvec3(0u) : all;
        flight[PROPAGATE_FLIGHT_RUN] = max(flight[PROPAGATE_FLIGHT_RUN], args.iteration);
    }
}
