#include "bench/characters/character_race.h"
#include "bench/characters/character_rows.h"
#include "bench/characters/scalar_match.h"
#include "content/make/person/person_skeleton.h"
#include "systems/animation/matching/match_step.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace limn::bench {

void add_match_rows(CharacterBench& bench);

namespace {

constexpr std::size_t kRows = 16384;
constexpr float kFrame = 1.0f / 60;

/// Takes of several styles of walking, so many that kRows frames are searched.
std::vector<MatchTake> make_bench_takes(const SkeletonData& skeleton) {
    std::vector<MatchTake> takes;
    float seconds = 0;
    for (int i = 0; seconds < 1.6f * static_cast<float>(kRows) * kMatchStep; ++i) {
        const auto style = static_cast<float>(i);
        Walk walk;
        walk.speed = 1.1f + 0.12f * style;
        walk.width = 0.6f + 0.1f * style;
        walk.tiredness = 0.08f * style;
        walk.sway = 0.02f + 0.004f * style;
        for (MatchTake& take : make_match_takes(skeleton, walk)) {
            seconds += take.clip.duration;
            takes.push_back(std::move(take));
        }
    }
    return takes;
}

/// What a character asks for that goes here and there, and how near what it plays is.
struct Question {
    MatchRow query{};
    float limit = 0;
};

std::vector<Question> ask(const MatchContext& context) {
    std::vector<Question> questions;
    MotionMatchState state;
    Transform transform;
    for (int i = 0; i < 60 * 24; ++i) {
        const auto leg = static_cast<float>(i / 90);
        const float speed = i / 90 % 4 == 3 ? 0.0f : 1.0f + 0.9f * static_cast<float>(i / 90 % 4);
        MoveIntent intent;
        intent.velocity = speed * Vec3(std::sin(1.7f * leg), 0, std::cos(1.7f * leg));
        step_motion_match(context, intent, kFrame, state, transform);
        if (i % 6 == 5) {
            const MatchRow query = make_match_query(context, intent, state, transform);
            const MatchRow& now = context.database.frame_at({state.clip, state.time});
            questions.push_back({query, row_distance(now, query) * (1 - context.match.better)});
        }
    }
    return questions;
}

}  // namespace

void add_match_rows(CharacterBench& bench) {
    const SkeletonData skeleton = make_person_skeleton(measure_person({}));
    const Assets assets;
    const MotionMatch match;
    const MatchDatabase database =
        make_match_database(skeleton, assets, {}, make_bench_takes(skeleton), weights_of(match));
    const MatchContext context = {assets, skeleton, database, match};
    const std::vector<Question> questions = ask(context);
    // The first kRows of them, as both searches and as plain rows.
    std::vector<MatchRow> rows;
    for (std::size_t i = 0; i < std::min(kRows, database.rows.count); ++i) {
        rows.push_back(database.rows.row(i));
    }
    const MatchRows made = make_match_rows(rows);
    std::size_t sum = 0;
    const auto times = race(
        thread_seconds, std::min(bench.repeats, 20),
        [&] {
            for (const Question& question : questions) {
                sum += nearest_by_hand(
                    rows[0].data(), rows.size(), kMatchFeatures, question.query.data());
            }
        },
        [&] {
            for (const Question& question : questions) {
                sum += find_nearest_row(made, question.query).row;
            }
        },
        [&] {
            for (const Question& question : questions) {
                sum += find_nearest_row_boxes(made, question.query).row;
            }
        },
        [&] {
            for (const Question& question : questions) {
                sum += find_nearest_row_boxes(made, question.query, question.limit).row;
            }
        });
    keep(&sum);
    const double per_row =
        1e9 / (static_cast<double>(questions.size()) * static_cast<double>(rows.size()));
    const auto add = [&](const char* gate, const char* name, double seconds, double limit,
                         double stretch) {
        bench.add(
            {.gate = gate,
             .name = name,
             .ours = seconds * per_row,
             .reference = times[0] * per_row,
             .against = "plain loops",
             .limit = limit,
             .stretch = stretch,
             .vectors = true});
    };
    add("13", "motion matching, all of 16,384 rows, per row", times[1], 0.15, 0.12);
    add("13", "motion matching, boxes on takes of walks, per row", times[2], 0.05, 0.02);
    add("", "motion matching, boxes, as near as what plays, per row", times[3], 0, 0);

    MotionMatchState state;
    Transform transform;
    LocalPose pose;
    constexpr int kSteps = 600;
    const auto step = race(thread_seconds, kMinRepeats, [&] {
        for (int i = 0; i < kSteps; ++i) {
            const float angle = 0.01f * static_cast<float>(i);
            MoveIntent intent;
            intent.velocity = 1.4f * Vec3(std::sin(angle), 0, std::cos(angle));
            step_motion_match(context, intent, kFrame, state, transform);
            find_match_pose(context, state, transform, pose);
        }
    });
    keep(&pose);
    bench.add(
        {.gate = "",
         .name = "motion matching, a step of a person with its searches",
         .ours = step[0] * 1e6 / kSteps,
         .unit = "us"});
}

}  // namespace limn::bench
