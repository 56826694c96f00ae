#include "content/load/gltf_document.h"
#include "ecs/base/rotation.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace limn {

namespace {

constexpr std::size_t kMaxJoints = std::numeric_limits<std::uint16_t>::max();

/// What a channel animates.
enum class Path : std::uint8_t { Rotation, Translation, Scale, Weights };
constexpr std::pair<std::string_view, Path> kPaths[] = {
    {"rotation", Path::Rotation},
    {"translation", Path::Translation},
    {"scale", Path::Scale},
    {"weights", Path::Weights}};

/// One joint's keys of one kind, or those of a node's morph weights.
struct Channel {
    Path path = Path::Rotation;
    std::uint16_t subject = 0;  ///< the joint, or the first of the weights
    std::size_t count = 1;      ///< of weights per row
    std::vector<float> values;  ///< of the sampler's output
};

/// Channels with the same times.
struct ChannelGroup {
    std::vector<float> times;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<Channel> channels;
};

/// Rows of its sheet; a cubic key has three.
std::size_t height_of(const ChannelGroup& group) {
    return group.times.size() * (group.interpolation == Interpolation::Cubic ? 3 : 1);
}

/// The keys of all channels of one kind as rows of one value per joint; cubic keys are three rows.
template <typename T>
void fill_rows(
    const ChannelGroup& group, Path path, std::vector<std::uint16_t>& joints, std::vector<T>& rows,
    T (*value_of)(const float* numbers)) {
    std::vector<const Channel*> chosen;
    for (const Channel& channel : group.channels) {
        if (channel.path == path) {
            chosen.push_back(&channel);
            joints.push_back(channel.subject);
        }
    }
    constexpr std::size_t kWidth = static_cast<std::size_t>(T::length());
    const std::size_t height = height_of(group);
    rows.reserve(height * chosen.size());
    for (std::size_t row = 0; row < height; ++row) {
        for (const Channel* channel : chosen) {
            rows.push_back(value_of(channel->values.data() + kWidth * row));
        }
    }
}

/// The same for weights, of which a channel has several consecutive ones.
void fill_weights(const ChannelGroup& group, ClipSheet& sheet) {
    for (const Channel& channel : group.channels) {
        for (std::size_t i = 0; channel.path == Path::Weights && i < channel.count; ++i) {
            sheet.morphing.push_back(static_cast<std::uint16_t>(channel.subject + i));
        }
    }
    for (std::size_t row = 0; row < height_of(group); ++row) {
        for (const Channel& channel : group.channels) {
            if (channel.path == Path::Weights) {
                const auto first =
                    channel.values.begin() + static_cast<std::ptrdiff_t>(row * channel.count);
                sheet.weights.insert(
                    sheet.weights.end(), first, first + static_cast<std::ptrdiff_t>(channel.count));
            }
        }
    }
}

Vec3 key_vector(const float* numbers) {
    return {numbers[0], numbers[1], numbers[2]};
}
Quat quaternion_of(const float* numbers) {
    return {numbers[3], numbers[0], numbers[1], numbers[2]};
}

class AnimationBuilder {
  public:
    AnimationBuilder(GltfDocument& document, GltfScene& scene)
        : document_(document), scene_(scene), animations_(document.model.animations) {}

    Status build() {
        LIMN_TRY(find_joints());
        LIMN_TRY(add_skins());
        return add_clips();
    }

  private:
    [[nodiscard]] std::string skin_place(std::size_t skin) const {
        return fmt::format("{}: skins[{}]", document_.file, skin);
    }

    /// The node of the scene that node `node` of the file became, -1 for none.
    [[nodiscard]] std::int32_t scene_node(int node) const {
        return node >= 0 ? item_at(document_.scene_nodes, node) : -1;
    }

    /// The nodes that a skin in use or a channel references.
    Result<std::vector<bool>> find_moving_nodes() {
        std::vector<bool> moves(scene_.nodes.size(), false);
        for (const GltfNode& node : scene_.nodes) {
            if (node.skin >= 0) {
                const auto skin = static_cast<std::size_t>(node.skin);
                for (const int joint : document_.model.skins[skin].joints) {
                    const std::int32_t found = scene_node(joint);
                    if (found < 0) {
                        return fail(
                            "{}.joints: found node {}, which is not in the scene", skin_place(skin),
                            joint);
                    }
                    moves[static_cast<std::size_t>(found)] = true;
                }
            }
        }
        for (const tinygltf::Animation& animation : animations_) {
            for (const tinygltf::AnimationChannel& channel : animation.channels) {
                const std::int32_t found = scene_node(channel.target_node);
                if (found >= 0 && channel.target_path != "weights") {
                    moves[static_cast<std::size_t>(found)] = true;
                }
            }
        }
        return moves;
    }

    Status find_joints() {
        std::vector<bool> moves = LIMN_TRY(find_moving_nodes());
        // Parents come before their children: propagate from the end to the ancestors.
        for (std::size_t i = scene_.nodes.size(); i-- > 0;) {
            if (moves[i] && scene_.nodes[i].parent >= 0) {
                moves[static_cast<std::size_t>(scene_.nodes[i].parent)] = true;
            }
        }
        scene_.joints.assign(scene_.nodes.size(), -1);
        const auto count = static_cast<std::size_t>(std::count(moves.begin(), moves.end(), true));
        if (count == 0) {
            return Done{};
        }
        if (count >= kMaxJoints) {
            return fail(
                "{}: nodes: found {} animated, expected at most {}", document_.file, count,
                kMaxJoints - 1);
        }
        scene_.skeleton.name = scene_.name;
        add_joint(scene_.name, -1, {});
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            if (moves[i]) {
                const GltfNode& node = scene_.nodes[i];
                const std::int32_t parent =
                    node.parent < 0 ? 0 : scene_.joints[static_cast<std::size_t>(node.parent)];
                scene_.joints[i] = static_cast<std::int32_t>(scene_.skeleton.joints.size());
                add_joint(node.name, parent, node.transform);
            }
        }
        if (Status status = check_skeleton(scene_.skeleton); !status) {
            return fail("{}: {}", document_.file, status.error().message);
        }
        return Done{};
    }

    void add_joint(const std::string& name, std::int32_t parent, const Transform& rest) {
        SkeletonData& skeleton = scene_.skeleton;
        skeleton.joints.push_back(name);
        skeleton.parents.push_back(parent);
        skeleton.rest.translations.push_back(rest.position);
        skeleton.rest.rotations.push_back(rest.rotation);
        skeleton.rest.scales.push_back(rest.scale);
    }

    [[nodiscard]] std::uint16_t joint_of(int node) const {
        return static_cast<std::uint16_t>(
            scene_.joints[static_cast<std::size_t>(scene_node(node))]);
    }

    /// Adds the skins in use, in order of first use, and updates the indices of the nodes.
    Status add_skins() {
        std::map<std::int32_t, std::int32_t> numbers;
        for (GltfNode& node : scene_.nodes) {
            if (node.skin < 0) {
                continue;
            }
            const auto [number, is_new] =
                numbers.try_emplace(node.skin, static_cast<std::int32_t>(scene_.skins.size()));
            if (is_new) {
                LIMN_TRY(add_skin(static_cast<std::size_t>(node.skin)));
            }
            node.skin = number->second;
        }
        return Done{};
    }

    Status add_skin(std::size_t index) {
        const tinygltf::Skin& source = document_.model.skins[index];
        SkinData skin;
        skin.name = source.name;
        for (const int joint : source.joints) {
            skin.joints.push_back(joint_of(joint));
        }
        skin.joint_from_mesh.resize(skin.joints.size());
        if (source.inverseBindMatrices >= 0) {
            const std::string place = skin_place(index) + ".inverseBindMatrices";
            const std::vector<float> values =
                LIMN_TRY(read_floats(document_, source.inverseBindMatrices, 16, place));
            if (values.size() < 16 * skin.joints.size()) {
                return fail(
                    "{}: found {} matrices, expected one for each of {} joints", place,
                    values.size() / 16, skin.joints.size());
            }
            for (std::size_t i = 0; i < skin.joints.size(); ++i) {
                const float* columns = values.data() + 16 * i;
                for (int row = 0; row < 3; ++row) {
                    skin.joint_from_mesh[i].row[row] = {
                        columns[row], columns[4 + row], columns[8 + row], columns[12 + row]};
                }
            }
        }
        if (Status status = check_skin(skin, scene_.skeleton.joints.size()); !status) {
            return fail("{}: {}", skin_place(index), status.error().message);
        }
        scene_.skins.push_back(std::move(skin));
        return Done{};
    }

    Status add_clips() {
        for (std::size_t i = 0; i < animations_.size(); ++i) {
            place_ = fmt::format("{}: animations[{}]", document_.file, i);
            groups_.clear();
            LIMN_TRY(read_channels(animations_[i]));
            const std::string& name = animations_[i].name;
            ClipData clip;
            clip.name = !name.empty() ? name : fmt::format("clip {}", i);
            for (const auto& [key, group] : groups_) {
                clip.sheets.push_back(make_sheet(group));
                clip.duration = std::max(clip.duration, group.times.back());
            }
            if (Status status =
                    check_clip(clip, scene_.skeleton.joints.size(), scene_.morph_weights.size());
                !status) {
                return fail("{}: {}", place_, status.error().message);
            }
            scene_.clips.push_back(std::move(clip));
        }
        return Done{};
    }

    Status read_channels(const tinygltf::Animation& animation) {
        for (std::size_t i = 0; i < animation.channels.size(); ++i) {
            const tinygltf::AnimationChannel& channel = animation.channels[i];
            const auto sampler = static_cast<std::size_t>(channel.sampler);
            if (sampler >= animation.samplers.size()) {
                return fail(
                    "{}.channels[{}].sampler: found the number {}, expected an index below {}",
                    place_, i, sampler, animation.samplers.size());
            }
            if (scene_node(channel.target_node) < 0) {
                continue;  // ignored, as specified; nodes outside of the scene likewise
            }
            const std::string& name = channel.target_path;
            const auto* path =
                std::find_if(std::begin(kPaths), std::end(kPaths), [&](const auto& known) {
                    return known.first == name;
                });
            const bool is_weights = path != std::end(kPaths) && path->second == Path::Weights;
            const GltfMorphs& morphs = item_at(document_.node_morphs, channel.target_node);
            if (path == std::end(kPaths) || (is_weights && morphs.count == 0)) {
                document_.warnings.push_back(fmt::format(
                    "{}.channels[{}].target.path: {} is ignored", place_, i, in_quotes(name)));
                continue;
            }
            const std::string place = fmt::format("{}.samplers[{}]", place_, sampler);
            Channel moved{path->second, 0, 1, {}};
            if (is_weights) {
                moved.subject = static_cast<std::uint16_t>(morphs.first);
                moved.count = morphs.count;
            } else {
                moved.subject = joint_of(channel.target_node);
            }
            LIMN_TRY(read_sampler(animation.samplers[sampler], place, std::move(moved)));
        }
        return Done{};
    }

    /// Reads the sampler's output into `channel` and adds that to the group with its times.
    Status read_sampler(
        const tinygltf::AnimationSampler& sampler, const std::string& place, Channel channel) {
        const std::string& word = sampler.interpolation;
        const Interpolation interpolation = word == "STEP"          ? Interpolation::Step
                                            : word == "CUBICSPLINE" ? Interpolation::Cubic
                                                                    : Interpolation::Linear;
        ChannelGroup& group = groups_[{sampler.input, interpolation}];
        if (group.times.empty()) {
            group.times = LIMN_TRY(read_floats(document_, sampler.input, 1, place + ".input"));
            group.interpolation = interpolation;
        }
        const int width = channel.path == Path::Weights    ? 1
                          : channel.path == Path::Rotation ? 4
                                                           : 3;
        channel.values = LIMN_TRY(read_floats(document_, sampler.output, width, place + ".output"));
        const std::size_t expected = height_of(group) * channel.count;
        const std::size_t found = channel.values.size() / static_cast<std::size_t>(width);
        if (found != expected) {
            return fail(
                "{}.output: found {} values, expected {} for {} keys{}{}", place, found, expected,
                group.times.size(),
                channel.path == Path::Weights ? fmt::format(" of {} morph targets", channel.count)
                                              : "",
                interpolation == Interpolation::Cubic ? ", with in- and out-tangents" : "");
        }
        group.channels.push_back(std::move(channel));
        return Done{};
    }

    static ClipSheet make_sheet(const ChannelGroup& group) {
        ClipSheet sheet;
        sheet.times = group.times;
        sheet.interpolation = group.interpolation;
        fill_rows(group, Path::Rotation, sheet.rotating, sheet.rotations, quaternion_of);
        fill_rows(group, Path::Translation, sheet.translating, sheet.translations, key_vector);
        fill_rows(group, Path::Scale, sheet.scaling, sheet.scales, key_vector);
        fill_weights(group, sheet);
        normalize_rotations(sheet);
        return sheet;
    }

    /// Normalizes rotations, each in the hemisphere of the previous key; scales tangents of cubic
    /// keys alike.
    static void normalize_rotations(ClipSheet& sheet) {
        const bool is_cubic = sheet.interpolation == Interpolation::Cubic;
        const std::size_t joints = sheet.rotating.size();
        const std::size_t step = (is_cubic ? 3 : 1) * joints;
        const std::size_t value = is_cubic ? joints : 0;
        for (std::size_t joint = 0; joint < joints; ++joint) {
            const Quat* previous = nullptr;
            for (std::size_t at = joint; at < sheet.rotations.size(); at += step) {
                Quat& key = sheet.rotations[at + value];
                const float length = glm::length(key);
                const float sign =
                    previous != nullptr && glm::dot(*previous, key) < 0.0f ? -1.0f : 1.0f;
                const float factor = length > 1e-6f ? sign / length : sign;
                for (std::size_t part = 0; part < step; part += joints) {
                    sheet.rotations[at + part] *= factor;
                }
                previous = &key;
            }
        }
    }

    GltfDocument& document_;
    GltfScene& scene_;
    const std::vector<tinygltf::Animation>& animations_;
    std::string place_;  ///< of the animation being read
    /// By input accessor and interpolation.
    std::map<std::pair<std::int32_t, Interpolation>, ChannelGroup> groups_;
};

}  // namespace

Status build_animations(GltfDocument& document, GltfScene& scene) {
    return AnimationBuilder(document, scene).build();
}

}  // namespace limn
