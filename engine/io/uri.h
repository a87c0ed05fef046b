// uri.h -- from uris in a scene to files beside it.
#pragma once
#include "io/json.h"

// The path that a uri of the document means: relative to the document, %XX decoded. NULL after a
// fault; else freed with free().
char *tyn_uri_path(const json_doc *doc, const cJSON *uri);

// A log that keeps the first error, so that what a reader said can be told together with the place
// of the scene that named the file.
typedef struct tyn_capture {
    tyn_log log;
    char message[1024];
} tyn_capture;
void tyn_capture_init(tyn_capture *capture);
// The whole file that a uri means; bytes are freed with free(). If there is no such file and `missing` is not NULL: true
// there, and bytes NULL.
tyn_result tyn_uri_read(const json_doc *doc, const cJSON *uri, void **bytes, size_t *size,
                        bool *missing);
// Faults at `uri` with the kept message; returns r.
tyn_result tyn_capture_fault(const tyn_capture *capture, const json_doc *doc, const cJSON *uri,
                             tyn_result r);
