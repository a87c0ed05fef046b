// importance_setup.comp -- places the grid.
#include "importance.glsl"

layout(local_size_x = 1) in;
TYN_UNIFORM(0, medium, medium_block medium);
TYN_UNIFORM(1, camera, camera_block camera);
TYN_WRITE(2, grid, importance_grid grid);
TYN_ARGS(importance_args args);

void main()
{
    grid = importance_grid_of(camera, medium.extent);
}
