#pragma once

#include "content/app/commands/headless.h"
#include "content/app/commands/render_command.h"
#include "content/app/commands/stage.h"
#include "ecs/entity.h"
#include "render/render_frame.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace limn {

// Frames of a scene, as `limn render` and the workers of `limn farm` draw them.

/// A loaded scene, one of its cameras, and what draws it.
struct RenderSession {
    std::unique_ptr<Stage> stage;
    Entity camera;
    HeadlessRenderer headless;
};

/// The camera of that name; "": the level's. Fails with the names that there are.
[[nodiscard]] Result<Entity> choose_camera(const Stage& stage, const std::string& name);

/// Loads the scene, with its assignments. Fails also for an unknown camera and for images larger
/// than the device can draw.
[[nodiscard]] Result<RenderSession> open_render(const RenderOptions& options);

/// What happens as the frames of a range are drawn; functions may be empty.
struct FrameEvents {
    std::function<void(int frame)> begin;  ///< before a frame that is wanted
    std::function<void()> progress;        ///< after each image, also those that frames depend on
    std::function<Status(int frame, const FrameOutput& image, double time)>
        write;  ///< a wanted frame, at its time [s]
};

/// Draws those frames of options.frames that are not `done`, in order, and the ones on which they
/// depend. So each is what it is where all are drawn by one call; only temporal antialiasing
/// remembers more frames than are drawn again, which shows in the last bits.
[[nodiscard]] Status render_frames(
    RenderSession& session, const RenderOptions& options, const std::vector<bool>& done,
    const FrameEvents& events);

/// One image with options.samples over lens and shutter; `progress` gets the number that are done.
FrameOutput draw_sampled_still(
    RenderSession& session, const RenderOptions& options, double time,
    const std::function<void(int)>& progress);

/// One frame at `time` [s] as `limn play` shows it, antialiased. First draws the frames it depends
/// on: the first one if probes keep what they captured, and the previous ones that motion blur
/// averages or temporal antialiasing accumulates.
[[nodiscard]] FrameOutput draw_still(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options, double time);

}  // namespace limn
