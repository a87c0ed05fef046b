// drop.c -- drops files on a window by the protocol Xdnd, as a file manager does.
//
// usage: drop WINDOW URI...      WINDOW: number, as xdotool prints it; exit 0 when the window says that it took them
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct drag {
    Display *display;
    Window from, to;
    Atom selection, list;
    char text[8192];
    bool finished, taken;
} drag;

static Atom atom(const drag *d, const char *name)
{
    return XInternAtom(d->display, name, False);
}

static void tell(const drag *d, const char *type, long a, long b, long c, long e)
{
    XEvent event = {.xclient = {.type = ClientMessage,
                                .window = d->to,
                                .message_type = atom(d, type),
                                .format = 32,
                                .data.l = {(long)d->from, a, b, c, e}}};
    XSendEvent(d->display, d->to, False, NoEventMask, &event);
    XFlush(d->display);
}

// Hands over the list of files.
static void answer(const drag *d, const XSelectionRequestEvent *request)
{
    XChangeProperty(d->display, request->requestor, request->property, request->target, 8,
                    PropModeReplace, (const unsigned char *)d->text, (int)strlen(d->text));
    XEvent event = {.xselection = {.type = SelectionNotify,
                                   .requestor = request->requestor,
                                   .selection = request->selection,
                                   .target = request->target,
                                   .property = request->property,
                                   .time = request->time}};
    XSendEvent(d->display, request->requestor, False, NoEventMask, &event);
    XFlush(d->display);
}

static void listen(drag *d, double seconds)
{
    for (int i = 0; i < (int)(100 * seconds) && !d->finished; i++) {
        while (XPending(d->display)) {
            XEvent event;
            XNextEvent(d->display, &event);
            if (event.type == SelectionRequest) {
                answer(d, &event.xselectionrequest);
            } else if (event.type == ClientMessage) {
                const Atom type = event.xclient.message_type;
                d->taken =
                    d->taken || (type == atom(d, "XdndStatus") && event.xclient.data.l[1] & 1);
                d->finished = d->finished || type == atom(d, "XdndFinished");
            }
        }
        usleep(10000);
    }
}

int main(int argc, char **argv)
{
    drag d = {.display = XOpenDisplay(NULL)};
    if (argc < 3 || !d.display) {
        fprintf(stderr, "usage: drop WINDOW URI...\n");
        return 2;
    }
    for (int i = 2; i < argc; i++) {
        const size_t used = strlen(d.text);
        snprintf(d.text + used, sizeof d.text - used, "%s\r\n", argv[i]);
    }
    d.to = strtoul(argv[1], NULL, 0);
    d.from = XCreateSimpleWindow(d.display, DefaultRootWindow(d.display), 0, 0, 1, 1, 0, 0, 0);
    d.selection = atom(&d, "XdndSelection");
    d.list = atom(&d, "text/uri-list");
    XSetSelectionOwner(d.display, d.selection, d.from, CurrentTime);
    tell(&d, "XdndEnter", 5L << 24, (long)d.list, 0, 0);
    tell(&d, "XdndPosition", 0, 50L << 16 | 50, CurrentTime, (long)atom(&d, "XdndActionCopy"));
    listen(&d, 0.5);
    tell(&d, "XdndDrop", 0, CurrentTime, 0, 0);
    listen(&d, 20);
    XCloseDisplay(d.display);
    return d.finished && d.taken ? 0 : 1;
}
