// data_folder.h -- where the program finds what was built or installed with it.
#pragma once

// The folder of the sample scenes: of the build tree that the program lies in, ../samples/scenes, or of an installation,
// ../share/tyndall/scenes. A string to be freed; NULL: out of memory.
char *data_folder_scenes(void);
