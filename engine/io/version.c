// version.c -- keeps libtyndall-io linkable before it has formats.
int tyn_io_version_unused;
