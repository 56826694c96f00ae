#include "tests/app/close_window.h"

#include <X11/Xlib.h>

// Apart from the tests: Xlib defines Status and None as macros.

namespace limn::test {

bool close_window(const std::string& display) {
    Display* const server = XOpenDisplay(display.c_str());
    if (server == nullptr) {
        return false;
    }
    const Atom protocols = XInternAtom(server, "WM_PROTOCOLS", False);
    Window root = 0;
    Window parent = 0;
    Window* windows = nullptr;
    unsigned int count = 0;
    unsigned int sent = 0;
    XQueryTree(server, DefaultRootWindow(server), &root, &parent, &windows, &count);
    for (unsigned int i = 0; i < count; ++i) {
        XWindowAttributes attributes{};
        if (XGetWindowAttributes(server, windows[i], &attributes) == 0
            || attributes.map_state != IsViewable) {
            continue;
        }
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = windows[i];
        event.xclient.message_type = protocols;
        event.xclient.format = 32;
        event.xclient.data.l[0] = static_cast<long>(XInternAtom(server, "WM_DELETE_WINDOW", False));
        sent += XSendEvent(server, windows[i], False, NoEventMask, &event) != 0 ? 1 : 0;
    }
    XFree(windows);
    XCloseDisplay(server);
    return sent > 0;
}

}  // namespace limn::test
