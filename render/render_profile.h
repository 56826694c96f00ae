#pragma once

#include "ecs/base/result.h"
#include "render/render_frame.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

namespace gpu {
class Device;
struct DeviceCaps;
}  // namespace gpu

// Ways to draw the world, one of which is loaded at a time (engine.render-profile,
// engine.profile-select). A profile is a list of effects and the test whether a device can run it;
// code that all of them share, such as meshes and materials, knows nothing of them. A program adds
// profiles of its own by passing another list:
//
//     ProfileSwitch profiles(device);
//     LIMN_TRY(profiles.load("plain"));
//     render_frame(profiles.renderer(), world, view);
//     profiles.request("full");          // in the middle of a frame
//     LIMN_TRY(profiles.begin_frame());  // now it takes effect
//
// Shaders belong to the device, so that profiles share them.

struct RenderProfile {
    const char* name;  ///< as in --renderer
    const char* doc;   ///< one line
    /// Whether a device can run it; changes nothing.
    bool (*test)(const gpu::DeviceCaps& caps);
    std::span<const EffectEntry> (*image)();  ///< lives as long as the program
};

/// Those of the library, the best first; the last one runs on every device.
[[nodiscard]] std::span<const RenderProfile> render_profiles();

/// The profile of this name; without a name the first that the device can run. Fails with the names
/// of those that it can.
[[nodiscard]] Result<const RenderProfile*> find_profile(
    const gpu::DeviceCaps& caps, std::string_view name,
    std::span<const RenderProfile> profiles = render_profiles());

class ProfileSwitch {
  public:
    /// `profiles` and `device` must outlive it. Loads nothing.
    explicit ProfileSwitch(
        gpu::Device& device, const RenderSettings& settings = {},
        std::span<const RenderProfile> profiles = render_profiles());

    /// Those that the device can run.
    [[nodiscard]] std::vector<const RenderProfile*> available() const;

    /// Loads a profile, by find_profile(), after freeing the objects of the one that was loaded;
    /// one that is loaded already stays as it is. After a failure it is as if nothing was asked,
    /// or, if effects could not be created, nothing is loaded.
    Status load(std::string_view name = {});
    /// Remembers a name until the next begin_frame().
    void request(std::string_view name) { requested_ = name; }
    /// Loads what was requested; fails if nothing is loaded then. True if the renderer is another.
    [[nodiscard]] Result<bool> begin_frame();
    /// Frees everything that a profile has made.
    void reset();

    /// Null if none is.
    [[nodiscard]] const RenderProfile* loaded() const { return loaded_; }
    /// Aborts if no profile is loaded.
    [[nodiscard]] Renderer& renderer() const;

  private:
    gpu::Device& device_;
    RenderSettings settings_;
    std::span<const RenderProfile> profiles_;
    const RenderProfile* loaded_ = nullptr;
    RendererPtr renderer_;
    std::string requested_;
};

}  // namespace limn
