// html.c -- report.json as one self-contained page.
//
// The page is tools/bench/page/page.html with five marks replaced: its style, its script, report.json and the
// pictures. Everything else happens in the browser: page/*.js. What comes from files (names, warnings)
// stays JSON until the script writes it as text, and JSON has no "<" here, so that nothing in it can
// end its block.
#include "html.h"
#include "html_picture.h"
#include "bench/page.h"
#include "text.h"
#include <tyndall/io.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- which pictures ---------------------------------------------------------------------------

static const char *string_of(const cJSON *object, const char *name)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, name));
}

static double number_of(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_IsNumber(item) ? item->valuedouble : INFINITY;
}

// The error over the largest blocks; infinite where there is none.
static double error_of(const cJSON *run)
{
    double error = INFINITY, block = 0;
    const cJSON *e;
    cJSON_ArrayForEach(e, cJSON_GetObjectItemCaseSensitive(run, "errors"))
    {
        if (number_of(e, "block") > block) {
            block = number_of(e, "block");
            error = number_of(e, "error");
        }
    }
    return error;
}

static double time_of(const cJSON *run)
{
    return number_of(cJSON_GetObjectItemCaseSensitive(run, "frame_ms"), "animated_light");
}

static bool on_front(const cJSON *scene, const char *key)
{
    const cJSON *front, *entry;
    cJSON_ArrayForEach(front, cJSON_GetObjectItemCaseSensitive(scene, "fronts"))
    {
        cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(front, "runs"))
        {
            const char *other = cJSON_GetStringValue(entry);
            if (other && key && strcmp(other, key) == 0) {
                return true;
            }
        }
    }
    return false;
}

// 0: no run of its group has a smaller error; 1: none is faster; 2: neither.
static int rank_in_group(const cJSON *runs, const cJSON *run)
{
    bool best = true, fastest = true;
    const char *group = string_of(run, "group");
    const cJSON *other;
    cJSON_ArrayForEach(other, runs)
    {
        const char *its = string_of(other, "group");
        if (other != run && group && its && strcmp(group, its) == 0) {
            best = best && error_of(run) <= error_of(other);
            fastest = fastest && time_of(run) <= time_of(other);
        }
    }
    return best ? 0 : fastest ? 1 : 2;
}

typedef struct candidate {
    const cJSON *run;
    int index, rank;
} candidate;

static int by_rank(const void *a, const void *b)
{
    const candidate *x = a, *y = b;
    return x->rank != y->rank ? (x->rank > y->rank) - (x->rank < y->rank) : x->index - y->index;
}

// ---- the page ---------------------------------------------------------------------------------

static void add_picture(app *a, text *page, const char *dir, const char *file, int scene, int run)
{
    char *path = text_format("%s/%s", dir, file);
    html_picture picture = {0};
    if (path && html_picture_read(a, path, &picture)) {
        text_add(page, "<script type=\"text/plain\" id=\"picture-%d-", scene);
        text_add(page, run < 0 ? "reference" : "%d", run);
        text_add(page, "\" data-width=\"%u\" data-height=\"%u\" data-exponent=\"%d\">",
                 picture.width, picture.height, picture.exponent);
        text_put(page, picture.base64, strlen(picture.base64));
        text_add(page, "</script>\n");
    }
    html_picture_finish(&picture);
    free(path);
}

static void add_scene_pictures(app *a, text *page, const char *dir, const cJSON *scene, int index)
{
    const cJSON *runs = cJSON_GetObjectItemCaseSensitive(scene, "runs"), *run;
    const char *reference =
        string_of(cJSON_GetObjectItemCaseSensitive(scene, "reference"), "picture");
    if (reference) {
        add_picture(a, page, dir, reference, index, -1);
    }
    candidate *list = calloc((size_t)cJSON_GetArraySize(runs) + 1, sizeof *list);
    int count = 0, position = 0;
    if (!list) {
        page->failed = true;
        return;
    }
    cJSON_ArrayForEach(run, runs)
    {
        if (string_of(run, "picture")) {
            const bool front = on_front(scene, string_of(run, "key"));
            list[count++] = (candidate){
                run, position, front || string_of(run, "preset") ? -1 : rank_in_group(runs, run)};
        }
        position++;
    }
    qsort(list, (size_t)count, sizeof *list, by_rank);
    for (int i = 0; i < count && i < HTML_PICTURES; i++) {
        add_picture(a, page, dir, string_of(list[i].run, "picture"), index, list[i].index);
    }
    free(list);
}

// JSON whose strings hold no "<" as such: "</script>" and "<!--" are then nothing to the browser.
static void add_json(text *page, const char *json)
{
    for (const char *end; (end = strchr(json, '<')); json = end + 1) {
        text_put(page, json, (size_t)(end - json));
        text_add(page, "\\u003c");
    }
    text_put(page, json, strlen(json));
}

static void add_lines(text *page, const char *const *lines, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        text_put(page, lines[i], strlen(lines[i]));
    }
}

static void add_pictures(app *a, text *page, const char *dir, const cJSON *report)
{
    int index = 0;
    const cJSON *scene;
    cJSON_ArrayForEach(scene, cJSON_GetObjectItemCaseSensitive(report, "scenes"))
    {
        add_scene_pictures(a, page, dir, scene, index++);
    }
}

int html_write(app *a, const cJSON *report, const char *dir, const char *path)
{
    text page = {0};
    // Printed and read again: numbers may have been made as raw text.
    char *json = cJSON_PrintUnformatted(report);
    cJSON *tree = json ? cJSON_Parse(json) : NULL;
    page.failed = !tree;
    for (size_t i = 0; i < ARRAY_SIZE(page_html) && !page.failed; i++) {
        const char *line = page_html[i];
        if (strcmp(line, "{{style}}\n") == 0) {
            add_lines(&page, page_css, ARRAY_SIZE(page_css));
        } else if (strcmp(line, "{{script}}\n") == 0) {
            add_lines(&page, page_js, ARRAY_SIZE(page_js));
        } else if (strcmp(line, "{{report}}\n") == 0) {
            add_json(&page, json);
        } else if (strcmp(line, "{{pictures}}\n") == 0) {
            add_pictures(a, &page, dir, tree);
        } else {
            text_put(&page, line, strlen(line));
        }
    }
    tyn_result result =
        page.failed ? TYN_ERR_MEMORY : tyn_file_write(path, page.bytes, page.size, &a->log);
    cJSON_Delete(tree);
    cJSON_free(json);
    text_finish(&page);
    return result < 0 ? app_exit_code(a, result, false) : EXIT_DONE;
}
