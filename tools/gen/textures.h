// textures.h -- stone.png and slabs.png of the sample scenes.
#pragma once
#include <stdbool.h>

bool gen_write_textures(const char *folder);
