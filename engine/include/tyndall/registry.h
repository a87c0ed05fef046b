// registry.h -- which passes and methods there are, and values for their parameters. Tier 3.
#pragma once
#include "context.h"
#include "pass.h"

#ifdef __cplusplus
extern "C" {
#endif

TYN_API uint32_t tyn_num_passes(void);
TYN_API const tyn_pass_desc *tyn_pass_at(uint32_t index);

typedef struct tyn_method_info {
    const char *name, *summary;
    const tyn_pass_desc *const *passes; // NULL-terminated, in the order of the frame
    uint32_t outputs;                   // set of tyn_output it can make
    bool progressive;                   // adds view.num_samples samples a call to what it has
    bool traces_rays; // surfaces need a hierarchy: tyn_surfaces_build_nodes of <tyndall/io.h>
} tyn_method_info;
TYN_API uint32_t tyn_num_methods(void);
TYN_API void tyn_method_at(uint32_t index, tyn_method_info *info);

TYN_API tyn_result tyn_settings_create(tyn_settings **out);
TYN_API void tyn_settings_destroy(tyn_settings **settings);
// "lattice.cells", "32": unknown names, bad numbers and values out of range are one log line and
// TYN_ERR_PARAMS.
TYN_API tyn_result tyn_settings_set(tyn_settings *settings, const char *name, const char *value,
                                    const tyn_log *log);
// "draft", "normal", "high".
TYN_API tyn_result tyn_settings_quality(tyn_settings *settings, const char *preset,
                                        const tyn_log *log);
// Defaults of the pass, then what was set.
TYN_API void tyn_settings_params(const tyn_settings *settings, const tyn_pass_desc *pass,
                                 void *params);

#ifdef __cplusplus
}
#endif
