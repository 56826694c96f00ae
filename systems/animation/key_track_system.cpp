#include "systems/animation/key_track_system.h"

#include "ecs/any_component.h"
#include "ecs/base/log.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"
#include "ecs/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Techniques: anim.key-track

namespace limn {
namespace {

KeyTrackState check_tracks(const KeyTrack& track) {
    KeyTrackState state;
    for (const FieldTrack& each : track.tracks) {
        const Result<TrackTarget> target = find_track_target(each);
        if (!target) {
            log_error("{}", target.error().message);
        }
        state.targets.push_back(target ? *target : TrackTarget{});
    }
    return state;
}

/// A value to be stored.
struct TrackWrite {
    Entity entity;
    TrackTarget target;
    Vec4 value;
    bool restarts = false;  ///< its loop began again in this step
};

bool restarts(const FieldTrack& track, double time, double step) {
    const double duration = static_cast<double>(track.times.back() - track.times.front());
    const double played = time - static_cast<double>(track.times.front());
    return track.wrap == TrackWrap::Loop && duration > 0 && played >= duration
           && std::floor(played / duration) != std::floor((played - step) / duration);
}

void store(World& world, const TrackWrite& write) {
    const TrackTarget& target = write.target;
    AnyComponent component = AnyComponent::read(world, write.entity, *target.component);
    if (component.is_empty()) {
        return;
    }
    void* const element = static_cast<std::byte*>(component.data()) + target.offset;
    const FieldMeta& meta = target.field->meta;
    for (int i = 0; i < number_count(target.field->type); ++i) {
        const double value = std::clamp(static_cast<double>(write.value[i]), meta.min, meta.max);
        (void)set_number(*target.field, element, value, i).ok();  // in range
    }
    world.write(write.entity, target.component->id, component.data());
    if (write.restarts && target.component->id == component_id<Transform>) {
        world.add(write.entity, Teleport{});
    }
}

}  // namespace

void add_key_track_states(Query<const KeyTrack, Without<KeyTrackState>> tracks, Commands commands) {
    tracks.each(
        [&](Entity entity, const KeyTrack& track) { commands.add(entity, check_tracks(track)); });
}

void prepare_key_tracks(Query<const KeyTrack, KeyTrackState, Changed<KeyTrack>> tracks) {
    tracks.each([](const KeyTrack& track, KeyTrackState& state) { state = check_tracks(track); });
}

void update_key_tracks(World& world) {
    const FrameTime* const time = std::as_const(world).find_resource<FrameTime>();
    if (time == nullptr) {
        return;
    }
    std::vector<TrackWrite> writes;
    world.query<const KeyTrack, const KeyTrackState>().each(
        [&](Entity entity, const KeyTrack& track, const KeyTrackState& state) {
            for (std::size_t i = 0; i < std::min(state.targets.size(), track.tracks.size()); ++i) {
                const TrackTarget& target = state.targets[i];
                const FieldTrack& each = track.tracks[i];
                if (target.field != nullptr && !each.times.empty()) {
                    writes.push_back(
                        {entity, target, track_value(each, target.field->type, time->time),
                         restarts(each, time->time, time->step)});
                }
            }
        });
    for (const TrackWrite& write : writes) {
        store(world, write);
    }
}

}  // namespace limn
