// hidpi.c -- preloaded into the viewer: a screen with two pixels in a unit of the window and of the pointer.
#include <dlfcn.h>

typedef struct GLFWwindow GLFWwindow;
typedef void (*on_cursor)(GLFWwindow *, double, double);
void glfwGetWindowSize(GLFWwindow *window, int *width, int *height);
void glfwGetCursorPos(GLFWwindow *window, double *x, double *y);
on_cursor glfwSetCursorPosCallback(GLFWwindow *window, on_cursor callback);

static on_cursor user;

void glfwGetWindowSize(GLFWwindow *window, int *width, int *height)
{
    void (*next)(GLFWwindow *, int *, int *);
    *(void **)&next = dlsym(RTLD_NEXT, "glfwGetWindowSize");
    next(window, width, height);
    *width /= 2;
    *height /= 2;
}

void glfwGetCursorPos(GLFWwindow *window, double *x, double *y)
{
    void (*next)(GLFWwindow *, double *, double *);
    *(void **)&next = dlsym(RTLD_NEXT, "glfwGetCursorPos");
    next(window, x, y);
    *x /= 2;
    *y /= 2;
}

static void halved(GLFWwindow *window, double x, double y)
{
    if (user) {
        user(window, x / 2, y / 2);
    }
}

on_cursor glfwSetCursorPosCallback(GLFWwindow *window, on_cursor callback)
{
    on_cursor (*next)(GLFWwindow *, on_cursor), before = user;
    *(void **)&next = dlsym(RTLD_NEXT, "glfwSetCursorPosCallback");
    user = callback;
    next(window, halved);
    return before;
}
