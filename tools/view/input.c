// input.c -- keys and mouse.
#include "view/panel.h"
#include "view/viewer.h"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <math.h>
#include <tyndall/registry.h>

static viewer *viewer_of(GLFWwindow *window)
{
    return glfwGetWindowUserPointer(window);
}

// ---- mouse ------------------------------------------------------------------------------------

static bool held(GLFWwindow *window, int button)
{
    return glfwGetMouseButton(window, button) == GLFW_PRESS;
}

static bool key_held(GLFWwindow *window, int key)
{
    return glfwGetKey(window, key) == GLFW_PRESS;
}

void input_window_size(const viewer *v, float *width, float *height)
{
    int w, h;
    glfwGetWindowSize(v->window, &w, &h);
    *width = w > 0 ? (float)w : 1;
    *height = h > 0 ? (float)h : 1;
}

// From the units of the pointer to pixels.
static void to_pixels(const viewer *v, double *x, double *y)
{
    float width, height;
    input_window_size(v, &width, &height);
    *x *= v->view.width / width;
    *y *= v->view.height / height;
}

static void find_pointer(viewer *v)
{
    glfwGetCursorPos(v->window, &v->mouse[0], &v->mouse[1]);
    to_pixels(v, &v->mouse[0], &v->mouse[1]);
}

static void on_move(GLFWwindow *window, double x, double y)
{
    viewer *v = viewer_of(window);
    v->woken = true; // the panel
    to_pixels(v, &x, &y);
    const float right = (float)(x - v->mouse[0]), down = (float)(y - v->mouse[1]);
    v->mouse[0] = x;
    v->mouse[1] = y;
    const bool left_button = held(window, GLFW_MOUSE_BUTTON_LEFT);
    const bool shift =
        key_held(window, GLFW_KEY_LEFT_SHIFT) || key_held(window, GLFW_KEY_RIGHT_SHIFT);
    const bool control =
        key_held(window, GLFW_KEY_LEFT_CONTROL) || key_held(window, GLFW_KEY_RIGHT_CONTROL);
    if (!v->dragging || (right == 0 && down == 0)) {
        return;
    }
    if (v->splitting) {
        v->comparison.split = fminf(fmaxf((float)x / (float)v->view.width, 0.02f), 0.98f);
        return;
    }
    const float height = (float)v->view.height;
    if (held(window, GLFW_MOUSE_BUTTON_MIDDLE) || (left_button && shift)) {
        camera_control_pan(&v->camera, -right / height, down / height);
    } else if (left_button && control) {
        camera_control_dolly(&v->camera, expf(2 * down / height));
    } else if (left_button) {
        camera_control_orbit(&v->camera, 3 * right / height, -3 * down / height);
    } else if (held(window, GLFW_MOUSE_BUTTON_RIGHT)) {
        camera_control_look(&v->camera, 1.5f * right / height, -1.5f * down / height);
    } else {
        return;
    }
    viewer_touch(v);
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    (void)button;
    (void)mods;
    viewer *v = viewer_of(window);
    if (action == GLFW_PRESS) {
        find_pointer(v); // it may not have moved yet
        const double split = v->comparison.split * v->view.width;
        v->dragging = !panel_has_mouse();
        v->splitting = comparison_seen(v) && fabs(v->mouse[0] - split) < 6;
    }
    v->woken = true;
}

static void on_scroll(GLFWwindow *window, double x, double y)
{
    (void)x;
    viewer *v = viewer_of(window);
    v->woken = true;
    if (!panel_has_mouse()) {
        camera_control_dolly(&v->camera, expf(-0.12f * (float)y));
        viewer_touch(v);
    }
}

// ---- keys -------------------------------------------------------------------------------------

static void turn_by_key(viewer *v, int key)
{
    const float step = 0.0872665f; // 5 degrees
    camera_control_orbit(&v->camera,
                         key == GLFW_KEY_LEFT    ? -step
                         : key == GLFW_KEY_RIGHT ? step
                                                 : 0,
                         key == GLFW_KEY_UP     ? step
                         : key == GLFW_KEY_DOWN ? -step
                                                : 0);
    viewer_touch(v);
}

static void on_key(GLFWwindow *window, int key, int scancode, int action, int mods)
{
    (void)scancode;
    (void)mods;
    viewer *v = viewer_of(window);
    v->woken = true;
    if (action == GLFW_RELEASE || panel_has_keyboard()) {
        return;
    }
    if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9) {
        viewer_set_method(v, (uint32_t)(key - GLFW_KEY_1));
        return;
    }
    switch (key) {
    case GLFW_KEY_LEFT:
    case GLFW_KEY_RIGHT:
    case GLFW_KEY_UP:
    case GLFW_KEY_DOWN:
        turn_by_key(v, key);
        break;
    case GLFW_KEY_PAGE_UP:
    case GLFW_KEY_PAGE_DOWN:
        camera_control_dolly(&v->camera, key == GLFW_KEY_PAGE_UP ? 0.9f : 1 / 0.9f);
        viewer_touch(v);
        break;
    case GLFW_KEY_TAB:
        viewer_set_layer(v, pictures_next_layer(v));
        break;
    case GLFW_KEY_E:
        comparison_toggle(v);
        break;
    case GLFW_KEY_P:
        find_pointer(v);
        probe_place(v);
        break;
    case GLFW_KEY_S:
        v->save_wanted = !held(window, GLFW_MOUSE_BUTTON_RIGHT);
        break;
    case GLFW_KEY_SPACE:
        v->playing = !v->playing;
        break;
    case GLFW_KEY_COMMA:
    case GLFW_KEY_PERIOD:
        v->playing = false;
        source_turn_to(v, key == GLFW_KEY_COMMA ? v->number - 1 : v->number + 1);
        break;
    case GLFW_KEY_H:
        v->show_panel = !v->show_panel;
        break;
    case GLFW_KEY_O:
        v->turntable = !v->turntable;
        viewer_touch(v);
        break;
    case GLFW_KEY_R:
        v->camera = v->first_camera;
        viewer_touch(v);
        break;
    case GLFW_KEY_ESCAPE:
    case GLFW_KEY_Q:
        glfwSetWindowShouldClose(window, GLFW_TRUE);
        break;
    default:
        break;
    }
}

void input_step(viewer *v, double seconds)
{
    GLFWwindow *w = v->window;
    const float step = 0.35f * (float)seconds;
    if (held(w, GLFW_MOUSE_BUTTON_RIGHT) && v->dragging) {
        const float right = key_held(w, GLFW_KEY_D) - key_held(w, GLFW_KEY_A);
        const float ahead = key_held(w, GLFW_KEY_W) - key_held(w, GLFW_KEY_S);
        if (right != 0 || ahead != 0) {
            camera_control_fly(&v->camera, right * step, 0, ahead * step);
            viewer_touch(v);
        }
    }
    if (v->turntable) {
        camera_control_orbit(&v->camera, 0.4f * (float)seconds, 0);
        viewer_touch(v);
    }
}

static void on_refresh(GLFWwindow *window)
{
    viewer_of(window)->woken = true;
}

static void on_drop(GLFWwindow *window, int count, const char **paths)
{
    for (int i = 0; i < count; i++) {
        source_drop(viewer_of(window), paths[i]);
    }
}

void input_open(viewer *v)
{
    glfwSetWindowUserPointer(v->window, v);
    glfwSetCursorPosCallback(v->window, on_move);
    glfwSetMouseButtonCallback(v->window, on_button);
    glfwSetScrollCallback(v->window, on_scroll);
    glfwSetKeyCallback(v->window, on_key);
    glfwSetDropCallback(v->window, on_drop);
    glfwSetWindowRefreshCallback(v->window, on_refresh);
}
