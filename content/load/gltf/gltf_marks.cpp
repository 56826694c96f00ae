#include "content/load/gltf/gltf_marks.h"

#include "ecs/base/text.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn {
namespace {

class MarkReader {
  public:
    MarkReader(
        GltfDocument& document, std::size_t animation, const SkeletonData& skeleton, float duration)
        : document_(document), skeleton_(skeleton), duration_(duration),
          where_(format_text("{}: animations[{}].extras.limn", document.file, animation)) {}

    std::optional<ClipContact> read_contact(const JsonValue& json, std::size_t index) {
        part_ = format_text("contacts[{}]", index);
        const std::string& name = json["joint"].text;
        const auto joint = std::find(skeleton_.joints.begin(), skeleton_.joints.end(), name);
        if (json["joint"].kind != JsonKind::String || joint == skeleton_.joints.end()) {
            const std::vector<std::string_view> names(
                skeleton_.joints.begin(), skeleton_.joints.end());
            return warn(format_text(
                "joint: found {}, expected the name of a joint{}", describe(json["joint"]),
                did_you_mean(name, names)));
        }
        const std::optional<float> begin = read_time(json, "begin");
        const std::optional<float> end = read_time(json, "end");
        if (!begin || !end) {
            return std::nullopt;
        }
        if (*begin > *end) {
            return warn(
                format_text("end: found {}, expected at least the begin, {}", *end, *begin));
        }
        return ClipContact{
            static_cast<std::uint16_t>(joint - skeleton_.joints.begin()), *begin, *end};
    }

    std::optional<ClipEvent> read_event(const JsonValue& json, std::size_t index) {
        part_ = format_text("events[{}]", index);
        if (json["name"].kind != JsonKind::String) {
            return warn(format_text("name: found {}, expected a string", describe(json["name"])));
        }
        const std::optional<float> time = read_time(json, "time");
        return time ? std::optional(ClipEvent{json["name"].text, *time}) : std::nullopt;
    }

  private:
    std::nullopt_t warn(const std::string& text) {
        document_.warnings.push_back(format_text("{}.{}.{}; it is left out", where_, part_, text));
        return std::nullopt;
    }

    std::optional<float> read_time(const JsonValue& json, std::string_view key) {
        if (json[key].kind != JsonKind::Number) {
            return warn(
                format_text("{}: found {}, expected a time in seconds", key, describe(json[key])));
        }
        return std::clamp(static_cast<float>(json[key].number), 0.0f, duration_);
    }

    GltfDocument& document_;
    const SkeletonData& skeleton_;
    float duration_;
    std::string where_;
    std::string part_;
};

}  // namespace

void read_clip_marks(
    GltfDocument& document, std::size_t animation, const SkeletonData& skeleton, ClipData& clip) {
    const JsonValue limn = extras_of(document, "animations", animation)["limn"];
    MarkReader reader(document, animation, skeleton, clip.duration);
    const std::vector<JsonValue>& contacts = limn["contacts"].items;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        if (const auto contact = reader.read_contact(contacts[i], i)) {
            clip.contacts.push_back(*contact);
        }
    }
    std::ranges::stable_sort(clip.contacts, {}, &ClipContact::begin);
    const std::vector<JsonValue>& events = limn["events"].items;
    for (std::size_t i = 0; i < events.size(); ++i) {
        if (const auto event = reader.read_event(events[i], i)) {
            clip.events.push_back(*event);
        }
    }
    std::ranges::stable_sort(clip.events, {}, &ClipEvent::time);
}

}  // namespace limn
