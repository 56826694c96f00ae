#include "bench/characters/character_crowd.h"
#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <vector>

namespace limn::bench {

void add_clip_rows(CharacterBench& bench);

namespace {

constexpr std::size_t kJoints = 67;

/// Local poses of all members, for both sides.
struct LocalPoses {
    std::vector<PoseRows> rows;
    std::vector<float> q;
    std::vector<float> t;

    LocalPoses(std::size_t count, std::size_t joints)
        : rows(count), q(count * joints * 4), t(count * joints * 3) {
        for (PoseRows& each : rows) {
            each.resize(joints);
        }
    }
};

/// Passes over all members until some hundred thousand joints are done, so that a run takes long
/// enough to be timed.
std::size_t passes_for(std::size_t count) {
    return std::max<std::size_t>(1, 200'000 / (count * kJoints));
}

double per_joint(double seconds, std::size_t count) {
    return seconds * 1e9 / static_cast<double>(count * kJoints * passes_for(count));
}

void sample_all(BenchCrowd& crowd, LocalPoses& poses) {
    for (std::size_t i = 0; i < crowd.members.size(); ++i) {
        const BenchCrowd::Member& member = crowd.members[i];
        sample_crowd_clip(crowd.clips[member.clip], member.time, poses.rows[i]);
    }
}

void sample_all_scalar(BenchCrowd& crowd, LocalPoses& poses) {
    for (std::size_t i = 0; i < crowd.members.size(); ++i) {
        const BenchCrowd::Member& member = crowd.members[i];
        sample_scalar(
            crowd.scalar_clips[member.clip], member.time, poses.q.data() + i * kJoints * 4,
            poses.t.data() + i * kJoints * 3);
    }
}

template <typename Run>
auto repeated(std::size_t count, Run run) {
    return [count, run] {
        for (std::size_t i = 0; i < passes_for(count); ++i) {
            run();
        }
    };
}

void add_sample_rows(CharacterBench& bench, std::size_t count, double limit, double stretch) {
    BenchCrowd crowd(kJoints, count);
    LocalPoses poses(count, kJoints);
    float advance = 0;  // of forward sampling
    const auto [ours, scalar, forward] = race(
        thread_seconds, bench.repeats, repeated(count, [&] { sample_all(crowd, poses); }),
        repeated(count, [&] { sample_all_scalar(crowd, poses); }), repeated(count, [&] {
            advance = advance < 1.9f ? advance + 1.0f / 60 : 0;
            for (std::size_t i = 0; i < count; ++i) {
                sample_crowd_clip(crowd.clips[crowd.members[i].clip], advance, poses.rows[i]);
            }
        }));
    bench.add(
        {.gate = "1",
         .name = fmt::format("sample at random times, {}", count),
         .ours = per_joint(ours, count),
         .reference = per_joint(scalar, count),
         .against = "scalar, floats",
         .limit = limit,
         .stretch = stretch,
         .peer = count == 2000 ? "2.5 (ACL)" : "2.2 (ACL)",
         .vectors = true});
    bench.add(
        {.gate = "2",
         .name = fmt::format("random times over forward, {}", count),
         .ours = per_joint(ours, count),
         .reference = per_joint(forward, count),
         .against = "forward, 1/60 s",
         .limit = 1.1,
         .stretch = 1.0,
         .peer = "2.7 (ozz)"});
}

/// In place: both write over one of the poses.
void add_blend_row(CharacterBench& bench, std::size_t count, double limit, double stretch) {
    BenchCrowd crowd(kJoints, count);
    LocalPoses a(count, kJoints);
    LocalPoses b(count, kJoints);

    sample_all(crowd, a);
    sample_all_scalar(crowd, a);
    std::swap(crowd.clips[0], crowd.clips[1]);
    sample_all(crowd, b);
    sample_all_scalar(crowd, b);
    const auto [ours, scalar] = race(
        thread_seconds, bench.repeats,
        repeated(
            count,
            [&] {
                for (std::size_t i = 0; i < count; ++i) {
                    blend_poses(a.rows[i], b.rows[i], crowd.members[i].weight, a.rows[i]);
                }
            }),
        repeated(count, [&] {
            for (std::size_t i = 0; i < count; ++i) {
                const std::size_t q = i * kJoints * 4;
                const std::size_t t = i * kJoints * 3;
                blend_scalar(
                    &a.q[q], &a.t[t], &b.q[q], &b.t[t], crowd.members[i].weight, kJoints, &a.q[q],
                    &a.t[t]);
            }
        }));
    bench.add(
        {.gate = "3",
         .name = fmt::format("blend, {}", count),
         .ours = per_joint(ours, count),
         .reference = per_joint(scalar, count),
         .against = "scalar, floats",
         .limit = limit,
         .stretch = stretch,
         .peer = count == 2000 ? "0.54 (ozz)" : "0.39 (ozz)",
         .vectors = true});
}

/// Local to model, and with the inverse bind matrices.
void add_matrix_row(
    CharacterBench& bench, const char* gate, std::size_t count, bool skin, double limit,
    double stretch, const char* peer) {
    BenchCrowd crowd(kJoints, count);
    LocalPoses poses(count, kJoints);
    sample_all(crowd, poses);
    sample_all_scalar(crowd, poses);
    std::vector<const PoseRows*> rows;
    std::vector<Affine*> joints;
    for (std::size_t i = 0; i < count; ++i) {
        rows.push_back(&poses.rows[i]);
        joints.push_back(crowd.matrices_of(i));
    }
    std::vector<float> model(kJoints * 12 * (skin ? 1 : count));
    std::vector<float> skinned(kJoints * 12 * count);
    const auto [ours, scalar] = race(
        thread_seconds, bench.repeats,
        repeated(
            count,
            [&] {
                compute_crowd_joints(
                    crowd.rig, rows, joints,
                    skin ? std::span<const Affine>(crowd.bind) : std::span<const Affine>());
            }),
        repeated(count, [&] {
            for (std::size_t i = 0; i < count; ++i) {
                float* const to = model.data() + (skin ? 0 : i * kJoints * 12);
                multiply_scalar(
                    crowd.skeleton.parents.data(), &poses.q[i * kJoints * 4],
                    &poses.t[i * kJoints * 3], kJoints, to);
                if (skin) {
                    skin_scalar(to, &crowd.bind[0].row[0].x, kJoints, &skinned[i * kJoints * 12]);
                }
            }
        }));
    bench.add(
        {.gate = gate,
         .name = fmt::format("local to model{}, {}", skin ? " and skin" : "", count),
         .ours = per_joint(ours, count),
         .reference = per_joint(scalar, count),
         .against = "scalar, floats",
         .limit = limit,
         .stretch = stretch,
         .peer = peer,
         .vectors = true});
}

}  // namespace

void add_clip_rows(CharacterBench& bench) {
    add_sample_rows(bench, 100, 0.25, 0.14);
    add_sample_rows(bench, 2000, 0.4, 0.27);
    add_blend_row(bench, 100, 0.25, 0.16);
    add_blend_row(bench, 2000, 0.5, 0.3);
    add_matrix_row(bench, "4", 100, false, 0.2, 0.08, "0.42 (ozz)");
    add_matrix_row(bench, "5", 2000, true, 0.3, 0.18, "0.45 (ozz)");
}

}  // namespace limn::bench
