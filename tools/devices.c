// devices.c -- the Vulkan devices of this machine.
#include "devices.h"
#include <stdio.h>
#include <stdlib.h>

enum { MAX_DEVICES = 16 };

int devices_list(app *a, devices *d)
{
    *d = (devices){.infos = calloc(MAX_DEVICES, sizeof *d->infos)};
    int count = d->infos ? tyn_devices_list(d->infos, MAX_DEVICES, &a->log) : TYN_ERR_MEMORY;
    if (count < 0) {
        return app_exit_code(a, (tyn_result)count, false);
    }
    if (count == 0) {
        app_error(a, "no Vulkan device; a software one is Mesa's lavapipe (mesa-vulkan-drivers)");
        return EXIT_FAILED;
    }
    d->count = count < MAX_DEVICES ? count : MAX_DEVICES;
    return EXIT_DONE;
}

void devices_finish(devices *d)
{
    free(d->infos);
    *d = (devices){0};
}

char *devices_describe(const tyn_device_info *info)
{
    char threads[48] = "";
    if (!info->capacity.software) {
        snprintf(threads, sizeof threads, ", %u threads", info->capacity.threads);
    }
    return text_format("%s%s, Vulkan %u.%u.%u, driver %s, heap %.1f GiB, %s%s", info->type, threads,
                       VK_API_VERSION_MAJOR(info->api_version),
                       VK_API_VERSION_MINOR(info->api_version),
                       VK_API_VERSION_PATCH(info->api_version), info->driver,
                       (double)info->heap_bytes / (1u << 30),
                       info->missing[0] ? "cannot be used, it lacks " : "usable", info->missing);
}
