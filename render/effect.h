#pragma once

#include "ecs/base/result.h"
#include "render/frame_data.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace limn {

struct FrameOutput;
struct RenderSettings;
struct RenderView;

// The interface of an effect in the list (image.h). An effect is a struct with some of these
// functions; only create() is required:
//
//     struct FrostEffect {
//         static Result<FrostEffect> create(gpu::Device&, const RenderSettings&);
//         static bool is_used(const FrameData&);        // absent: always, else on first use
//         void collect(FrameData&);                     // once a frame: read the world, upload
//         void request_views(FrameData&);               // once a frame, after every collect()
//         bool prepare(const FrameData&, ViewData&);    // once a view; false: not drawn in it
//         void draw_shared(FrameGraph&, const FrameData&);   // passes before those of any view
//         void draw(FrameGraph&, const FrameData&, ViewData&);
//         void report(const FrameData&, const ViewData&, FrameOutput&);  // for the main view
//         static void add_warm_up_views(const FrameData&, std::vector<RenderView>&);  // see below
//     };
//
// Each step is done for all effects, in the order of the list, before the next begins. The struct
// is the effect's state and lives until the renderer is destroyed or reset (warm_up,
// render_frame.h); passes may capture its address.
//
// No program should be compiled while a level is played. A level is warmed up when it is loaded:
// drawn from its cameras and from far enough to see all of it; once more with every light on, if
// some are off. An effect needs to do nothing for this if the definitions of its shaders follow
// from what the level holds (all lights of FrameData's LightList, all materials) rather than from
// what is visible in a view. For definitions that depend on the camera, add_warm_up_views() adds
// camera positions from which each of them is drawn. Whatever cannot be triggered by a camera
// position, such as a shadow map that a caster may enter later, checks FrameData::warm_up.

struct EffectEntry {
    std::uint32_t views;  ///< of ViewKind: in which prepare() and draw() are called

    bool (*is_used)(const FrameData&);  ///< null: always
    Result<void*> (*create)(gpu::Device&, const RenderSettings&);
    void (*destroy)(void*);
    void (*collect)(void*, FrameData&);
    void (*request_views)(void*, FrameData&);
    bool (*prepare)(void*, const FrameData&, ViewData&);
    void (*draw_shared)(void*, FrameGraph&, const FrameData&);
    void (*draw)(void*, FrameGraph&, const FrameData&, ViewData&);
    void (*report)(void*, const FrameData&, const ViewData&, FrameOutput&);
    void (*add_warm_up_views)(const FrameData&, std::vector<RenderView>&);
};

/// The entry of an effect in the list; functions that it lacks are null.
template <typename E>
[[nodiscard]] constexpr EffectEntry effect(std::uint32_t views) {
    EffectEntry entry{};
    entry.views = views;
    entry.create = [](gpu::Device& device, const RenderSettings& settings) -> Result<void*> {
        return static_cast<void*>(new E(LIMN_TRY(E::create(device, settings))));
    };
    entry.destroy = [](void* state) { delete static_cast<E*>(state); };
    if constexpr (requires { &E::is_used; }) {
        entry.is_used = &E::is_used;
    }
    if constexpr (requires { &E::collect; }) {
        entry.collect = [](void* e, FrameData& frame) { static_cast<E*>(e)->collect(frame); };
    }
    if constexpr (requires { &E::request_views; }) {
        entry.request_views = [](void* e, FrameData& frame) {
            static_cast<E*>(e)->request_views(frame);
        };
    }
    if constexpr (requires { &E::prepare; }) {
        entry.prepare = [](void* e, const FrameData& frame, ViewData& view) {
            return static_cast<E*>(e)->prepare(frame, view);
        };
    }
    if constexpr (requires { &E::draw_shared; }) {
        entry.draw_shared = [](void* e, FrameGraph& graph, const FrameData& frame) {
            static_cast<E*>(e)->draw_shared(graph, frame);
        };
    }
    if constexpr (requires { &E::draw; }) {
        entry.draw = [](void* e, FrameGraph& graph, const FrameData& frame, ViewData& view) {
            static_cast<E*>(e)->draw(graph, frame, view);
        };
    }
    if constexpr (requires { &E::report; }) {
        entry.report = [](void* e, const FrameData& frame, const ViewData& view, FrameOutput& out) {
            static_cast<E*>(e)->report(frame, view, out);
        };
    }
    if constexpr (requires { &E::add_warm_up_views; }) {
        entry.add_warm_up_views = &E::add_warm_up_views;
    }
    return entry;
}

}  // namespace limn
