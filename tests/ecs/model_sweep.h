#pragma once

#include "tests/ecs/model_run.h"
#include "tests/ecs/model_shape.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

// Operations on all that a query visits: writing, and what is done at once.

namespace limn::test::model {

class ModelSweep : public ModelRun {
  public:
    using ModelRun::ModelRun;

  protected:
    /// Writes a component of all that a query visits.
    void sweep() {
        count("sweep");
        const std::uint32_t way = roll(7);
        if (way == 3) {
            sweep_poses();
            return;
        }
        if (way == 4) {
            sweep_lamps();
            return;
        }
        if (way >= 5) {
            sweep_places();
            return;
        }
        const std::int64_t offset = roll(1000);
        const auto query = world_.query<ModelSpeed, const ModelPlace>();
        const auto write_row = [offset](ModelSpeed& speed, const ModelPlace& place) {
            speed.value = static_cast<double>(place.x) + static_cast<double>(offset);
        };
        if (way == 0) {
            query.each(write_row);
        } else if (way == 1) {
            query.par_each(write_row);
        } else {
            query.par_chunks(
                [&](ChunkView, std::span<ModelSpeed> speeds, std::span<const ModelPlace> places) {
                    for (std::size_t i = 0; i < speeds.size(); ++i) {
                        write_row(speeds[i], places[i]);
                    }
                });
        }
        for (const auto& [id, record] : reference_.records()) {
            if (record.has(Kind::Place) && record.has(Kind::Speed)) {
                reference_.set(id, Kind::Speed, {record.value(Kind::Place).number + offset, kNoId});
            }
        }
    }

    /// Of one team, or of all that are in a team or have a memo.
    void sweep_places() {
        const std::int64_t offset = roll(1000);
        const auto moved = [offset](std::int64_t number) { return (number + offset) % 1'000'000; };
        const auto write_row = [&](ModelPlace& place) {
            place = make<ModelPlace>(moved(read(place)), {});
        };
        const std::int64_t team = roll(kTeams);
        const auto members = world_.query<ModelPlace>().where(make<ModelTeam>(team, {}));
        Shape shape = shape_of<ModelPlace>(team);
        switch (roll(4)) {
        case 0:
            members.each(write_row);
            break;
        case 1:
            members.par_each(write_row);
            break;
        case 2:
            members.chunks([&](ChunkView, std::span<ModelPlace> places) {
                std::for_each(places.begin(), places.end(), write_row);
            });
            break;
        default:
            world_.query<ModelPlace, AnyOf<ModelTeam, ModelMemo>>().each(write_row);
            shape = shape_of<ModelPlace, AnyOf<ModelTeam, ModelMemo>>();
        }
        for (const auto& [id, record] : reference_.records()) {
            if (shape.matches(record)) {
                reference_.set(id, Kind::Place, {moved(record.value(Kind::Place).number), kNoId});
            }
        }
    }

    /// Lane by lane.
    void sweep_poses() {
        const std::int32_t offset = static_cast<std::int32_t>(roll(1000));
        world_.query<ModelPose, Without<ModelAwake>>().chunks(
            [&](ChunkView chunk, SplitSpan<ModelPose> poses) {
                const RowMask enabled = chunk.enabled();
                const auto at = poses.template field<&ModelPose::at>();
                const auto numbers = poses.template field<&ModelPose::number>();
                for (std::uint32_t row = 0; row < chunk.size(); ++row) {
                    if (enabled.test(row)) {
                        numbers[row] = (numbers[row] + offset) % 1'000'000;
                        const float x = static_cast<float>(numbers[row]);
                        at[0][row] = x;
                        at[1][row] = 2 * x;
                        at[2][row] = -x;
                    }
                }
            });
        for (const auto& [id, record] : reference_.records()) {
            if (record.matches(bit(Kind::Pose), bit(Kind::Awake))) {
                const std::int64_t number = (record.value(Kind::Pose).number + offset) % 1'000'000;
                reference_.set(id, Kind::Pose, {number, kNoId});
            }
        }
    }

    /// Enables and disables while iterating.
    void sweep_lamps() {
        const std::uint32_t modulus = 2 + roll(3);
        const auto is_lit = [modulus](std::int64_t number) {
            return static_cast<std::uint64_t>(number) % modulus != 0;
        };
        world_.query<const ModelPlace, Optional<ModelLamp>>().par_chunks(
            [&](ChunkView chunk, std::span<const ModelPlace> places, std::span<ModelLamp>) {
                for (std::uint32_t row = 0; chunk.has<ModelLamp>() && row < chunk.size(); ++row) {
                    chunk.set_enabled<ModelLamp>(row, is_lit(read(places[row])));
                }
            });
        for (const auto& [id, record] : reference_.records()) {
            if (record.has(Kind::Place) && record.has(Kind::Lamp)) {
                reference_.set_enabled(id, Kind::Lamp, is_lit(record.value(Kind::Place).number));
            }
        }
    }

    /// All of a query at once.
    void change_all() {
        const std::int64_t team = roll(kTeams);
        switch (roll(5)) {
        case 0:
            change_all_of<const ModelTitle, Without<ModelBadge>>();
            break;
        case 1:
            change_all_of<With<ModelPlace>, Without<ModelLamp>>();
            break;
        case 2:
            change_all_of<const ModelWarmth, With<ModelSpeed>>();
            break;
        case 3:
            change_all_of<With<ModelTitle>, AnyOf<ModelTeam, ModelSpeed>>();
            break;
        default:
            change_all_of(
                world_.query<With<ModelPlace>>().where(make<ModelTeam>(team, {})),
                shape_of<With<ModelPlace>>(team));
        }
    }

    template <typename... Terms>
    void change_all_of() {
        change_all_of(world_.query<Terms...>(), shape_of<Terms...>());
    }

    template <typename... Terms>
    void change_all_of(const Query<Terms...>& query, const Shape& shape) {
        std::vector<Id> ids;
        for (const auto& [id, record] : reference_.records()) {
            if (shape.matches(record)) {
                ids.push_back(id);
            }
        }
        const std::uint32_t way = roll(8);
        if (way == 0) {
            count("destroy_all");
            world_.destroy_all(query);
            for (const Id id : ids) {
                reference_.destroy(id);
            }
            return;
        }
        constexpr Kind kOften[] = {Kind::Tally, Kind::Memo, Kind::Badge,
                                   Kind::Pose,  Kind::Lamp, Kind::Team};
        const Kind kind = kOften[roll(std::size(kOften))];
        const Value value = any_value(kind, kNoId);
        with_kind(kind, [&]<typename T>() {
            if constexpr (bulk_kind<T>) {
                if (way < 4) {
                    count("add_all");
                    world_.add_all(query, make<T>(value.number, {}));
                } else {
                    count("remove_all");
                    world_.remove_all<T>(query);
                }
            }
        });
        for (const Id id : ids) {
            if (way < 4) {
                reference_.add(id, kind, value);
            } else {
                reference_.remove(id, kind);
            }
        }
    }
    template <typename T>
    static constexpr bool bulk_kind = (bit(kind_of<T>())
                                       & (bit(Kind::Tally) | bit(Kind::Memo) | bit(Kind::Badge)
                                          | bit(Kind::Pose) | bit(Kind::Lamp) | bit(Kind::Team)))
                                      != 0;
};

}  // namespace limn::test::model
