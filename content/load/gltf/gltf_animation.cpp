#include "content/load/gltf/gltf_document.h"
#include "content/load/gltf/gltf_freedoms.h"
#include "content/load/gltf/gltf_marks.h"
#include "ecs/base/rotation.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

// Techniques: anim.mocap-keys

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
    std::vector<std::size_t> keys;  ///< of the file, one for each time
    std::size_t count = 0;          ///< of the keys of the file
    Interpolation interpolation = Interpolation::Linear;
    std::vector<Channel> channels;
};

std::size_t rows_per_key(const ChannelGroup& group) {
    return group.interpolation == Interpolation::Cubic ? 3 : 1;
}

/// Rows of its sheet.
std::size_t height_of(const ChannelGroup& group) {
    return group.times.size() * rows_per_key(group);
}

bool are_all_finite(std::span<const float> values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

/// Of several keys at the same time, the first holds up to it and the last from it on: the first
/// moves to the preceding float, or is dropped if that is not after the previous key.
void part_equal_times(const std::vector<float>& times, ChannelGroup& group) {
    for (std::size_t i = 0; i < times.size(); ++i) {
        std::size_t last = i;
        while (last + 1 < times.size() && times[last + 1] == times[i]) {
            ++last;
        }
        const float before = std::nextafter(times[i], -INFINITY);
        if (last > i && times[i] > 0 && (group.times.empty() || before > group.times.back())) {
            group.times.push_back(before);
            group.keys.push_back(i);
        }
        group.times.push_back(times[i]);
        group.keys.push_back(last);
        i = last;
    }
}

/// The blocks of `size` numbers in `values` that belong to the keys of `group`.
std::vector<float>
choose_keys(const std::vector<float>& values, const ChannelGroup& group, std::size_t size) {
    std::vector<float> chosen;
    chosen.reserve(group.keys.size() * size);
    for (const std::size_t key : group.keys) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(key * size);
        chosen.insert(chosen.end(), first, first + static_cast<std::ptrdiff_t>(size));
    }
    return chosen;
}

/// The number of replaced keys, and the first one's value.
struct MendedKeys {
    std::size_t count = 0;
    std::size_t key = 0;
    std::string value;

    void add(std::size_t mended, std::span<const float> found) {
        if (count++ == 0) {
            key = mended;
            value = fmt::format("({})", fmt::join(found, ", "));
        }
    }
};

std::size_t width_of(Path path) {
    return path == Path::Weights ? 1 : path == Path::Rotation ? 4 : 3;
}

/// Whether the key is finite and, for a rotation, has a length.
bool is_good_key(std::span<const float> value, Path path) {
    float length2 = 0;
    for (const float x : value) {
        length2 += x * x;
    }
    return are_all_finite(value) && std::isfinite(length2)
           && (path != Path::Rotation || length2 > 1e-12f);
}

/// Replaces bad keys of one joint or weight: part(key, row) are its numbers.
template <typename Part>
Status
mend_keys_of(std::size_t keys, std::size_t rows, Path path, const Part& part, MendedKeys& mended) {
    const std::size_t value_row = rows == 3 ? 1 : 0;
    std::size_t good = 0;
    while (good < keys && !is_good_key(part(good, value_row), path)) {
        ++good;
    }
    if (good == keys) {
        return fail("found no key that is {}", path == Path::Rotation ? "a rotation" : "finite");
    }
    for (std::size_t key = 0; key < keys; ++key) {
        const bool is_good = is_good_key(part(key, value_row), path);
        for (std::size_t row = 0; row < rows; ++row) {
            const std::span<float> numbers = part(key, row);
            if (is_good && (row == value_row || are_all_finite(numbers))) {
                continue;
            }
            if (row == value_row || is_good) {
                mended.add(key, numbers);
            }
            if (row == value_row) {
                std::ranges::copy(part(good, value_row), numbers.begin());
            } else {
                std::ranges::fill(numbers, 0.0f);  // a slope
            }
        }
        good = is_good ? key : good;
    }
    return Done{};
}

/// Replaces values that are not finite, and rotations without length, by those of the previous key,
/// at the start by those of the next. Fails if a channel has no good key.
Result<MendedKeys> mend_keys(Channel& channel, std::size_t rows) {
    const std::size_t width = width_of(channel.path);
    const std::size_t size = rows * channel.count * width;  // of a key
    MendedKeys mended;
    for (std::size_t item = 0; item < channel.count; ++item) {
        LIMN_TRY(mend_keys_of(
            channel.values.size() / size, rows, channel.path,
            [&](std::size_t key, std::size_t row) {
                return std::span(channel.values)
                    .subspan(key * size + (row * channel.count + item) * width, width);
            },
            mended));
    }
    return mended;
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
        add_skins();
        add_clips();
        return Done{};
    }

  private:
    [[nodiscard]] std::string where_skin(std::size_t skin) const {
        return fmt::format("{}: skins[{}]", document_.file, skin);
    }

    /// The node of the scene that node `node` of the file became, -1 for none.
    [[nodiscard]] std::int32_t scene_node(int node) const {
        return node >= 0 ? item_at(document_.scene_nodes, node) : -1;
    }

    /// The nodes that a skin in use or a channel references.
    [[nodiscard]] std::vector<bool> find_moving_nodes() const {
        std::vector<bool> moves(scene_.nodes.size(), false);
        for (const GltfNode& node : scene_.nodes) {
            if (node.skin >= 0) {
                const auto skin = static_cast<std::size_t>(node.skin);
                for (const int joint : document_.model.skins[skin].joints) {
                    if (const std::int32_t found = scene_node(joint); found >= 0) {
                        moves[static_cast<std::size_t>(found)] = true;
                    }
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
        std::vector<bool> moves = find_moving_nodes();
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
                // Views list joints, and poses refer to them, by name.
                const std::string name = node.name.empty() ? free_joint_name() : node.name;
                add_joint(name, parent, node.transform);
            }
        }
        read_joint_limits(document_, scene_);
        if (Status status = check_skeleton(scene_.skeleton); !status) {
            return fail("{}: {}", document_.file, status.error().message);
        }
        return Done{};
    }

    /// Of a node without a name; no other node or joint has it.
    [[nodiscard]] std::string free_joint_name() const {
        for (std::size_t number = scene_.skeleton.joints.size();; ++number) {
            std::string name = fmt::format("joint {}", number);
            if (std::ranges::find(scene_.nodes, name, &GltfNode::name) == scene_.nodes.end()
                && std::ranges::find(scene_.skeleton.joints, name)
                       == scene_.skeleton.joints.end()) {
                return name;
            }
        }
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

    /// Adds the skins in use, in order of first use, and updates the indices of the nodes. A mesh
    /// without its skin is placed by its node.
    void add_skins() {
        std::map<std::int32_t, std::int32_t> numbers;
        for (const auto& [index, owner] : document_.skinned_nodes) {
            GltfNode& node = scene_.nodes[index];
            const auto [number, is_new] =
                numbers.try_emplace(node.skin, static_cast<std::int32_t>(scene_.skins.size()));
            if (is_new) {
                if (const Status added = add_skin(static_cast<std::size_t>(node.skin)); !added) {
                    number->second = -1;
                    warn_of_loss(document_, added.error(), "its meshes are drawn without it");
                }
            }
            node.skin = number->second;
            node.parent = node.skin < 0 ? static_cast<std::int32_t>(owner) : node.parent;
        }
    }

    Status add_skin(std::size_t index) {
        const tinygltf::Skin& source = document_.model.skins[index];
        SkinData skin;
        skin.name = source.name;
        for (const int joint : source.joints) {
            if (scene_node(joint) < 0) {
                return fail(
                    "{}.joints: found node {}, which is not in the scene", where_skin(index),
                    joint);
            }
            skin.joints.push_back(joint_of(joint));
        }
        skin.joint_from_mesh.resize(skin.joints.size());
        if (source.inverseBindMatrices >= 0) {
            const std::string where = where_skin(index) + ".inverseBindMatrices";
            const std::vector<float> values =
                LIMN_TRY(read_floats(document_, source.inverseBindMatrices, 16, where));
            if (values.size() < 16 * skin.joints.size()) {
                return fail(
                    "{}: found {} matrices, expected one for each of {} joints", where,
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
            return fail("{}: {}", where_skin(index), status.error().message);
        }
        scene_.skins.push_back(std::move(skin));
        return Done{};
    }

    void add_clips() {
        for (std::size_t i = 0; i < animations_.size(); ++i) {
            if (find_bad_part(document_, "animations", i) != nullptr) {
                continue;
            }
            part_ = fmt::format("animations[{}]", i);
            where_ = fmt::format("{}: {}", document_.file, part_);
            groups_.clear();
            moved_.clear();
            const bool is_whole = read_channels(animations_[i]);
            std::erase_if(groups_, [](const auto& group) { return group.second.channels.empty(); });
            if (!is_whole && groups_.empty()) {
                continue;
            }
            const std::string& name = animations_[i].name;
            ClipData clip;
            clip.name = !name.empty() ? name : fmt::format("clip {}", i);
            for (const auto& [key, group] : groups_) {
                clip.sheets.push_back(make_sheet(group));
                clip.duration = std::max(clip.duration, group.times.back());
            }
            read_clip_marks(document_, i, scene_.skeleton, clip);
            if (Status status =
                    check_clip(clip, scene_.skeleton.joints.size(), scene_.morph_weights.size());
                !status) {
                warn_of_loss(
                    document_, {fmt::format("{}: {}", where_, status.error().message)},
                    "it is left out");
                continue;
            }
            scene_.clips.push_back(std::move(clip));
        }
    }

    /// Whether no channel is lost.
    bool read_channels(const tinygltf::Animation& animation) {
        bool is_whole = true;
        for (std::size_t i = 0; i < animation.channels.size(); ++i) {
            if (find_bad_part(document_, part_ + ".channels", i) != nullptr) {
                is_whole = false;
                continue;
            }
            if (const Status read = read_channel(animation, i); !read) {
                is_whole = false;
                warn_of_loss(
                    document_,
                    {fmt::format("{}.channels[{}]: {}", where_, i, read.error().message)},
                    "the channel is left out");
            }
        }
        return is_whole;
    }

    Status read_channel(const tinygltf::Animation& animation, std::size_t index) {
        const tinygltf::AnimationChannel& channel = animation.channels[index];
        const auto sampler = static_cast<std::size_t>(channel.sampler);
        if (sampler >= animation.samplers.size()) {
            return fail(
                "sampler: found the number {}, expected an index below {}", sampler,
                animation.samplers.size());
        }
        if (scene_node(channel.target_node) < 0) {
            return Done{};  // ignored, as specified; nodes outside of the scene likewise
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
                "{}.channels[{}].target.path: {} is ignored", where_, index, in_quotes(name)));
            return Done{};
        }
        if (const std::string* const reason =
                find_bad_part(document_, part_ + ".samplers", sampler)) {
            return Error{*reason};
        }
        Channel moved{path->second, 0, 1, {}};
        if (is_weights) {
            moved.subject = static_cast<std::uint16_t>(morphs.first);
            moved.count = morphs.count;
        } else {
            moved.subject = joint_of(channel.target_node);
        }
        if (moved_.contains({moved.path, moved.subject})) {
            return fail("target: found the {} of node {} twice", name, channel.target_node);
        }
        LIMN_TRY(read_sampler(
            animation.samplers[sampler], fmt::format("samplers[{}]", sampler), std::move(moved)));
        return Done{};
    }

    /// The times of a group that has none yet.
    Status read_times(std::int32_t input, const std::string& where, ChannelGroup& group) {
        const std::vector<float> times = LIMN_TRY(read_floats(document_, input, 1, where));
        if (times.empty()) {
            return fail("{}: accessors[{}]: found no keys, expected at least one", where, input);
        }
        bool has_equal = false;
        for (std::size_t i = 1; i < times.size(); ++i) {
            if (times[i] < times[i - 1]) {
                return fail(
                    "{}: accessors[{}]: found {} after {} at key {}, expected increasing times",
                    where, input, times[i], times[i - 1], i);
            }
            if (times[i] == times[i - 1] && !has_equal) {
                has_equal = true;
                document_.warnings.push_back(fmt::format(
                    "{}.{}: accessors[{}]: found {} again at key {}, expected increasing times; "
                    "from then on the later key counts",
                    where_, where, input, times[i], i));
            }
        }
        group.count = times.size();
        part_equal_times(times, group);
        return Done{};
    }

    /// Reads the sampler's output into `channel` and adds that to the group with its times.
    Status read_sampler(
        const tinygltf::AnimationSampler& sampler, const std::string& where, Channel channel) {
        const std::string& word = sampler.interpolation;
        const Interpolation interpolation = word == "STEP"          ? Interpolation::Step
                                            : word == "CUBICSPLINE" ? Interpolation::Cubic
                                                                    : Interpolation::Linear;
        const std::pair key(sampler.input, interpolation);
        if (!groups_.contains(key)) {
            ChannelGroup made;
            made.interpolation = interpolation;
            LIMN_TRY(read_times(sampler.input, where + ".input", made));
            groups_.emplace(key, std::move(made));
        }
        ChannelGroup& group = groups_[key];
        const std::size_t width = width_of(channel.path);
        const std::string output = where + ".output";
        const std::vector<float> values =
            LIMN_TRY(read_any_floats(document_, sampler.output, static_cast<int>(width), output));
        const std::size_t rows = rows_per_key(group);
        const std::size_t expected = group.count * rows * channel.count;
        const std::size_t found = values.size() / width;
        if (found != expected) {
            return fail(
                "{}: found {} values, expected {} for {} keys{}{}", output, found, expected,
                group.count,
                channel.path == Path::Weights ? fmt::format(" of {} morph targets", channel.count)
                                              : "",
                interpolation == Interpolation::Cubic ? ", with in- and out-tangents" : "");
        }
        channel.values = choose_keys(values, group, rows * channel.count * width);
        const Result<MendedKeys> mended = mend_keys(channel, rows);
        if (!mended) {
            return fail("{}: accessors[{}]: {}", output, sampler.output, mended.error().message);
        }
        if (mended->count > 0) {
            document_.warnings.push_back(fmt::format(
                "{}.{}: accessors[{}]: found {} in key {}, expected {}; {} such keys are as the "
                "keys before them",
                where_, output, sampler.output, mended->value, group.keys[mended->key],
                channel.path == Path::Rotation ? "a rotation" : "finite numbers", mended->count));
        }
        moved_.insert({channel.path, channel.subject});
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
    std::string part_;                                ///< the animation being read
    std::string where_;                               ///< likewise, with the file
    std::set<std::pair<Path, std::uint16_t>> moved_;  ///< what it animates so far
    /// By input accessor and interpolation.
    std::map<std::pair<std::int32_t, Interpolation>, ChannelGroup> groups_;
};

}  // namespace

Status build_animations(GltfDocument& document, GltfScene& scene) {
    return AnimationBuilder(document, scene).build();
}

}  // namespace limn
