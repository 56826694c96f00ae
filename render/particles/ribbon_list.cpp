#include "render/particles/ribbon_list.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: engine.trail

namespace limn {
namespace {

constexpr float kSamePosition = 1e-4f;  // distance below which points are merged [m]
constexpr float kSharpTurn = 0.6f;      // above about this a turn gets a join [rad]
constexpr float kSmoothTurn = 0.1f;     // below about this it gets none [rad]
constexpr float kBranchSpread = 0.4f;   // of lightning's branches, by eye

/// Whether a miter would be too long, or the inner edges of the turn would cross.
bool is_sharp(const Vec3& before, const Vec3& point, const Vec3& after, float width) {
    const float came = glm::distance(before, point);
    const float goes = glm::distance(point, after);
    const float turn = glm::distance((point - before) / came, (after - point) / goes);
    return turn > kSharpTurn || (turn > kSmoothTurn && turn * width > std::min(came, goes));
}

RibbonPoint mix_points(const RibbonPoint& a, const RibbonPoint& b, float t) {
    return {
        a.position + (b.position - a.position) * t, a.u + (b.u - a.u) * t,
        a.span + (b.span - a.span) * t, a.curve_at + (b.curve_at - a.curve_at) * t};
}

/// Adds a point, or the end of the ribbon if that is before it. Returns whether the ribbon
/// continues.
bool add_point(std::vector<RibbonPoint>& strip, const RibbonPoint& point) {
    if (point.curve_at < 1 || strip.empty()) {
        strip.push_back(point);
        return point.curve_at < 1;
    }
    const RibbonPoint& last = strip.back();
    strip.push_back(
        mix_points(last, point, (1 - last.curve_at) / (point.curve_at - last.curve_at)));
    return false;
}

/// Turns distances into texture coordinates: with a tile, measured from the birth of the trail, so
/// that the texture stays with its points; else the image spans the whole ribbon.
void set_texture(std::vector<RibbonPoint>& strip, double head, float tile) {
    if (tile > 0) {
        const double turns = std::fmod(head / static_cast<double>(tile), 1024.0);
        for (RibbonPoint& point : strip) {
            point.u = point.u / tile - static_cast<float>(turns);
        }
    } else if (!strip.empty() && strip.back().u > 0) {
        const float length = strip.back().u;
        for (RibbonPoint& point : strip) {
            point.u /= length;
        }
    }
}

void append_strand(
    const Trail& trail, const TrailState& state, const TrailStrand& strand, float back, float step,
    RibbonList& list) {
    const float at = step > 0 && strand.live ? 1 - back / step : 1.0f;
    const TrailPoint& now = strand.head;
    const TrailPoint& then = strand.previous;
    const float life = std::max(trail.life, 1e-3f);
    const float length = std::max(trail.length, 1e-3f);
    const float spacing = trail_spacing(trail);
    const RibbonPoint head = {
        then.position + (now.position - then.position) * at, 0,
        then.span + (now.span - then.span) * at, std::max(now.age - back, 0.0f) / life};
    if (!(head.curve_at < 1)) {
        return;
    }
    float behind = 0;
    double travelled = 0;
    list.strip.push_back(head);
    for (std::uint32_t i = strand.count; i-- > 0;) {
        const TrailPoint& point = trail_point(state, strand, i);
        const float age = point.age - back;
        if (age < 0 && strand.live) {
            continue;  // the head has not been there yet
        }
        if (list.strip.size() == 1) {
            behind = glm::distance(head.position, point.position);
            travelled =
                static_cast<double>(strand.number - strand.count + i) * static_cast<double>(spacing)
                + static_cast<double>(behind);
        } else {
            behind += spacing;
        }
        const float curve_at = std::max({age / life, behind / length, head.curve_at});
        if (!add_point(list.strip, {point.position, behind, point.span, curve_at})) {
            break;
        }
    }
    set_texture(list.strip, travelled, trail.tile);
    list.add_strip();
}

/// Adds a ribbon along `points`, from position `curve_at` on the curves to 1.
void add_line(const std::vector<Vec3>& points, float curve_at, float tile, RibbonList& list) {
    float along = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        along += i > 0 ? glm::distance(points[i - 1], points[i]) : 0.0f;
        const float at = static_cast<float>(i) / static_cast<float>(points.size() - 1);
        list.strip.push_back({points[i], along, Vec3(0), curve_at + (1 - curve_at) * at});
    }
    set_texture(list.strip, 0, tile);
    list.add_strip();
}

}  // namespace

void RibbonList::clear() {
    points.clear();
    segments.clear();
    strip.clear();
}

void RibbonList::add_strip() {
    const auto end =
        std::unique(strip.begin(), strip.end(), [](const RibbonPoint& a, const RibbonPoint& b) {
            return !(glm::distance(a.position, b.position) > kSamePosition);
        });
    strip.erase(end, strip.end());
    if (strip.size() >= 2) {
        const std::size_t first = points.size();
        const RibbonPoint& head = strip.front();
        const RibbonPoint& tail = strip.back();
        points.insert(points.end(), {strip[1], head, head});
        for (std::size_t i = 1; i + 1 < strip.size(); ++i) {
            points.push_back(strip[i]);
            if (is_sharp(strip[i - 1].position, strip[i].position, strip[i + 1].position, width)) {
                points.push_back(strip[i]);
            }
        }
        points.insert(points.end(), {tail, tail, strip[strip.size() - 2]});
        for (std::size_t before = first; before + 3 < points.size(); ++before) {
            segments.push_back(static_cast<std::uint32_t>(before));
        }
    }
    strip.clear();
}

void append_trail(
    const Trail& trail, const TrailState& state, float back, float step, RibbonList& list) {
    for (const TrailStrand& strand : state.strands) {
        append_strand(trail, state, strand, back, step, list);
    }
}

void append_births(
    const Trail& trail, const ParticlePool& pool, float back, const Vec3* head, RibbonList& list) {
    const double first = static_cast<double>(pool.clock.born) - static_cast<double>(pool.size());
    const auto spacing = static_cast<double>(trail_spacing(trail));
    double travelled = static_cast<double>(pool.clock.born) * spacing;
    const auto end_strip = [&] {
        set_texture(list.strip, travelled, trail.tile);
        list.add_strip();
    };
    if (head != nullptr) {
        list.strip.push_back({*head, 0, Vec3(0), 0});
    }
    for (std::size_t i = pool.size(); i-- > 0;) {
        const float age = pool.age[i] - back;
        if (age < 0) {
            continue;
        }
        const Vec3 velocity = {pool.vx[i], pool.vy[i], pool.vz[i]};
        const Vec3 position = Vec3(pool.x[i], pool.y[i], pool.z[i]) - velocity * back;
        if (!list.strip.empty()
            && !(glm::distance(position, list.strip.back().position) <= trail.jump)) {
            end_strip();
        }
        const double along = (first + static_cast<double>(i)) * spacing;
        travelled = list.strip.empty() ? along : travelled;
        const float curve_at = std::clamp(age / std::max(pool.life[i], 1e-6f), 0.0f, 1.0f);
        list.strip.push_back({position, static_cast<float>(travelled - along), Vec3(0), curve_at});
    }
    end_strip();
}

void append_beam(
    const Beam& beam, const BeamState& state, Entity entity, float alpha, double time,
    RibbonList& list) {
    if (!state.shown) {
        return;
    }
    const Vec3 start = glm::mix(state.previous_start, state.start, alpha);
    const Vec3 end = glm::mix(state.previous_end, state.end, alpha);
    const float length = glm::distance(start, end);
    const bool jagged = beam.jag > 0;
    Random random = beam_random(beam, entity, time);
    make_bolt(start, end, beam.jag, jagged ? beam.detail : 0, random, list.bolt);
    add_line(list.bolt, 0, beam.tile, list);
    for (std::uint32_t i = 0; jagged && i < beam.branches; ++i) {
        const auto pieces = static_cast<std::uint32_t>(list.bolt.size() - 1);
        const std::uint32_t fork = 1 + random.below(std::max(pieces - 1, 1u));
        const float curve_at = static_cast<float>(fork) / static_cast<float>(pieces);
        const Vec3 aside = {random.normal(), random.normal(), random.normal()};
        const Vec3 tip = list.bolt[fork]
                         + random.uniform(0.1f, 0.35f) * (1 - curve_at)
                               * ((end - start) + kBranchSpread * length * aside);
        make_bolt(
            list.bolt[fork], tip, beam.jag, std::max(beam.detail, 2u) - 2, random, list.branch);
        add_line(list.branch, curve_at, beam.tile, list);
    }
}

}  // namespace limn
