// devices.h -- the Vulkan devices of this machine.
#pragma once
#include "app.h"
#include <tyndall/device.h>

typedef struct devices {
    tyn_device_info *infos;
    int count; // >= 1 after devices_list gave EXIT_DONE
} devices;

int devices_list(app *a, devices *d); // gives the exit code; devices_finish is due in any case
void devices_finish(devices *d);

// "cpu, Vulkan 1.3.230, driver ..., heap 2.0 GiB, usable": a new string.
char *devices_describe(const tyn_device_info *info);
