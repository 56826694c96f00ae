#include "render/render_profile.h"

#include "ecs/base/check.h"
#include "ecs/base/text.h"
#include "render/gpu/device.h"
#include "render/image.h"

#include <utility>

// Techniques: engine.profile-select, engine.render-profile

namespace limn {
namespace {

constexpr int kFullTextures = 32;  ///< units that the programs of all effects together need

bool runs_full(const gpu::DeviceCaps& caps) {
    return caps.max_fragment_textures >= kFullTextures && caps.max_compute_invocations > 0;
}

bool runs_always(const gpu::DeviceCaps&) {
    return true;
}

constexpr RenderProfile kProfiles[] = {
    {"full", "every effect", runs_full, standard_image},
    {"plain", "without caustics, probes, shadows of particles, and what a lens adds", runs_always,
     plain_image},
};

}  // namespace

std::span<const RenderProfile> render_profiles() {
    return kProfiles;
}

Result<const RenderProfile*> find_profile(
    const gpu::DeviceCaps& caps, std::string_view name, std::span<const RenderProfile> profiles) {
    std::string names;
    for (const RenderProfile& profile : profiles) {
        if (!profile.test(caps)) {
            continue;
        }
        if (name.empty() || name == profile.name) {
            return &profile;
        }
        names += names.empty() ? profile.name : std::string(" ") + profile.name;
    }
    if (names.empty()) {
        return fail("found no way to render on {}, expected at least one", caps.renderer);
    }
    return fail("found the renderer \"{}\", expected one of {}", name, names);
}

ProfileSwitch::ProfileSwitch(
    gpu::Device& device, const RenderSettings& settings, std::span<const RenderProfile> profiles)
    : device_(device), settings_(settings), profiles_(profiles) {}

std::vector<const RenderProfile*> ProfileSwitch::available() const {
    std::vector<const RenderProfile*> found;
    for (const RenderProfile& profile : profiles_) {
        if (profile.test(device_.caps())) {
            found.push_back(&profile);
        }
    }
    return found;
}

Status ProfileSwitch::load(std::string_view name) {
    const RenderProfile* const profile = LIMN_TRY(find_profile(device_.caps(), name, profiles_));
    if (profile == loaded_) {
        return Done{};
    }
    reset();  // first, so that both never take memory at once
    settings_.image = profile->image();
    renderer_ = LIMN_TRY(create_renderer(device_, settings_));
    loaded_ = profile;
    return Done{};
}

Result<bool> ProfileSwitch::begin_frame() {
    const RenderProfile* const before = loaded_;
    if (!requested_.empty()) {
        const std::string name = std::exchange(requested_, {});
        LIMN_TRY(load(name));
    }
    if (loaded_ == nullptr) {
        return fail("found no renderer, expected one to be loaded");
    }
    return loaded_ != before;
}

void ProfileSwitch::reset() {
    renderer_.reset();
    loaded_ = nullptr;
}

Renderer& ProfileSwitch::renderer() const {
    LIMN_CHECK(renderer_ != nullptr);
    return *renderer_;
}

}  // namespace limn
