#include "render/gpu/context.h"

#include "ecs/base/text.h"
#include "render/gpu/device_caps.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace limn::gpu {
namespace {

/// A display that may provide a context.
struct Candidate {
    EGLenum platform = EGL_NONE;
    void* native = nullptr;
    bool software = false;
    std::string name;
};

bool has_extension(const char* list, std::string_view name) {
    const std::string_view all = list != nullptr ? list : "";
    for (std::size_t at = all.find(name); at != std::string_view::npos;
         at = all.find(name, at + 1)) {
        const std::size_t end = at + name.size();
        if ((at == 0 || all[at - 1] == ' ') && (end == all.size() || all[end] == ' ')) {
            return true;
        }
    }
    return false;
}

std::vector<Candidate> list_candidates() {
    std::vector<Candidate> candidates;
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const bool platforms = has_extension(client, "EGL_EXT_platform_base");
    const bool devices = has_extension(client, "EGL_EXT_device_base")
                         || (has_extension(client, "EGL_EXT_device_enumeration")
                             && has_extension(client, "EGL_EXT_device_query"));
    if (platforms && devices && has_extension(client, "EGL_EXT_platform_device")) {
        std::array<EGLDeviceEXT, 32> found = {};
        EGLint count = 0;
        if (eglQueryDevicesEXT(static_cast<EGLint>(found.size()), found.data(), &count)
            == EGL_TRUE) {
            for (EGLint i = 0; i < count; ++i) {
                const char* extensions =
                    eglQueryDeviceStringEXT(found[static_cast<std::size_t>(i)], EGL_EXTENSIONS);
                const bool software = has_extension(extensions, "EGL_MESA_device_software");
                candidates.push_back(
                    {EGL_PLATFORM_DEVICE_EXT, found[static_cast<std::size_t>(i)], software,
                     fmt::format("EGL device {}{}", i, software ? " (software)" : "")});
            }
        }
    }
    if (platforms && has_extension(client, "EGL_MESA_platform_surfaceless")) {
        candidates.push_back(
            {EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, true, "EGL surfaceless"});
    }
    return candidates;
}

bool asks_for_software() {
    const char* wish = std::getenv("LIMN_GL_DEVICE");
    return wish != nullptr && std::string_view(wish) == "software";
}

/// Applies LIMN_GL_DEVICE; hardware first if it is not set.
Result<std::vector<Candidate>> choose_candidates(std::vector<Candidate> all) {
    const char* wish = std::getenv("LIMN_GL_DEVICE");
    const std::string_view choice = wish != nullptr ? wish : "";
    const auto keep = [&](auto&& predicate) {
        std::erase_if(all, [&](const Candidate& c) { return !predicate(c); });
    };
    if (choice == "gpu") {
        keep([](const Candidate& c) { return !c.software; });
    } else if (choice == "software") {
        keep([](const Candidate& c) { return c.software; });
    } else if (choice == "surfaceless") {
        keep([](const Candidate& c) { return c.platform == EGL_PLATFORM_SURFACELESS_MESA; });
    } else if (!choice.empty()) {
        if (choice.size() > 2 || choice.find_first_not_of("0123456789") != std::string_view::npos) {
            return fail(
                "LIMN_GL_DEVICE: '{}' found, expected an index, gpu, software or surfaceless",
                choice);
        }
        const auto index = static_cast<std::size_t>(std::atoi(wish));
        if (index >= all.size() || all[index].platform != EGL_PLATFORM_DEVICE_EXT) {
            return fail("LIMN_GL_DEVICE: device {} found, expected one that EGL lists", choice);
        }
        all = {all[index]};
    } else {
        std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
            return !a.software && b.software;
        });
    }
    return all;
}

/// A config for OpenGL with any surface type, as nothing is presented.
EGLConfig find_config(EGLDisplay display) {
    constexpr std::array<EGLint, 5> kWanted = {
        EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, kWanted.data(), &config, 1, &count) == EGL_TRUE && count > 0) {
        return config;
    }
    return nullptr;  // EGL_NO_CONFIG_KHR
}

EGLContext create_egl_context(EGLDisplay display, EGLConfig config, bool debug, EGLContext share) {
    const std::array<EGLint, 9> attributes = {
        EGL_CONTEXT_MAJOR_VERSION,
        4,
        EGL_CONTEXT_MINOR_VERSION,
        5,
        EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
        EGL_CONTEXT_OPENGL_DEBUG,
        debug ? EGL_TRUE : EGL_FALSE,
        EGL_NONE};
    return eglCreateContext(display, config, share, attributes.data());
}

}  // namespace

Result<std::unique_ptr<Context>> create_headless_context(const ContextDesc& desc) {
    // Calling EGL where libEGL is missing would make epoxy abort.
    if (!epoxy_has_egl()) {
        return fail(
            "OpenGL: no libEGL.so.1 found, expected EGL 1.5 (Debian: libegl1, libegl-mesa0)");
    }
    Result<std::vector<Candidate>> candidates = choose_candidates(list_candidates());
    if (!candidates) {
        return candidates.error();
    }
    std::string reasons;
    for (const Candidate& candidate : *candidates) {
        const auto skip = [&](const char* why) {
            reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", candidate.name, why);
        };
        const EGLDisplay display =
            desc.share != nullptr
                ? desc.share->display_
                : eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
        if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
            skip("no display");
            continue;
        }
        if (!has_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")
            || eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
            skip("no OpenGL without a surface");
            continue;
        }
        const EGLConfig config = desc.share != nullptr ? desc.share->config_ : find_config(display);
        const EGLContext share = desc.share != nullptr ? desc.share->context_ : EGL_NO_CONTEXT;
        const EGLContext made = create_egl_context(display, config, desc.debug, share);
        if (made == EGL_NO_CONTEXT) {
            skip("no OpenGL 4.5 core");
            continue;
        }
        std::unique_ptr<Context> context(new Context);
        context->display_ = display;
        context->context_ = made;
        context->config_ = config;
        context->origin_ = desc.share != nullptr ? desc.share->origin_ : candidate.name;
        if (!context->make_current()) {
            skip("cannot be made current");
            continue;
        }
        if (asks_for_software() && !read_device_caps().software) {
            skip("not software, which LIMN_GL_DEVICE asks for");  // any driver may be surfaceless
            continue;
        }
        return context;
    }
    return fail(
        "OpenGL: {}, expected a device with OpenGL 4.5 core",
        reasons.empty() ? "no EGL device found" : reasons);
}

Context::~Context() {
    // The display stays initialized: it is shared by every context of the process.
    if (eglGetCurrentContext() == context_) {
        release_current();
    }
    eglDestroyContext(display_, context_);
}

Status Context::make_current() {
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
        return fail("{}: context found in use by another thread", origin_);
    }
    return Done{};
}

void Context::release_current() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

}  // namespace limn::gpu
