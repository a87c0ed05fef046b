// cache.h -- where the tool keeps what it can make again.
#pragma once

// $XDG_CACHE_HOME/tyndall/NAME, else ~/.cache/tyndall/NAME: a new string, its folders made as far as
// that is possible. NULL: there is no place.
char *cache_path(const char *name);
