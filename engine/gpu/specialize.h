// specialize.h -- SPIR-V with its specialization constants filled in, without the code that they switch off.
//
// Drivers translate and inline every function and branch of a module before they fold constants. A kernel with 32 features
// would pay for all of them in every variant.
#pragma once
#include <stddef.h>
#include <stdint.h>

// Writes the module with constant i set to spec[i] (i < num_spec) to `out`, which has room for `count` words: selections
// whose condition is known become branches, and blocks and functions that nothing reaches go. Code stays whole in a module
// with 64-bit integers, decoration groups or instructions beyond SPIR-V 1.6's core. Constants that are not of 32 bits keep
// their default. What is not a whole module is copied, for the driver to refuse. Returns the words written; 0: no memory.
size_t tyn_spirv_specialize(const uint32_t *words, size_t count, const uint32_t *spec,
                            uint32_t num_spec, uint32_t *out);
