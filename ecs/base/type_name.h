#pragma once

#include <string>
#include <string_view>

namespace limn {

namespace detail {

template <typename Type>
constexpr const char* signature_of_type() {
    return __PRETTY_FUNCTION__;
}
template <auto Value>
constexpr const char* signature_of_value() {
    return __PRETTY_FUNCTION__;
}

/// The text after `key` in "... [with Type = limn::Water]" (gcc) or "... [Type = limn::Water]"
/// (clang).
constexpr std::string_view argument_of(std::string_view signature, std::string_view key) {
    signature.remove_prefix(signature.rfind(key) + key.size());
    signature.remove_suffix(1);
    if (!signature.empty() && signature.front() == '&') {
        signature.remove_prefix(1);
    }
    return signature;
}

}  // namespace detail

/// The name with its namespaces: "limn::PointLight".
template <typename Type>
constexpr std::string_view type_name() {
    return detail::argument_of(detail::signature_of_type<Type>(), "Type = ");
}

/// The name of a function or other constant, with its namespaces: "limn::update_water".
template <auto Value>
constexpr std::string_view value_name() {
    return detail::argument_of(detail::signature_of_value<Value>(), "Value = ");
}

/// The name without namespaces: "PointLight". Template arguments stay.
constexpr std::string_view short_name(std::string_view name) {
    const std::size_t arguments = name.find('<');
    const std::size_t scope = name.substr(0, arguments).rfind("::");
    return scope == std::string_view::npos ? name : name.substr(scope + 2);
}

/// "PointLight" -> "point_light", "HDRImage" -> "hdr_image"; other characters become '_'.
[[nodiscard]] std::string snake_case(std::string_view name);

/// The closest match for `name` among `names`, by edit distance; empty if none is close.
template <typename Names>
[[nodiscard]] std::string nearest_name(std::string_view name, const Names& names);

/// How many insertions, deletions, substitutions or adjacent swaps turn a into b.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

template <typename Names>
std::string nearest_name(std::string_view name, const Names& names) {
    std::string nearest;
    std::size_t best = name.size() / 3 + 2;  // larger distances are different words, not typos
    for (const auto& candidate : names) {
        const std::size_t distance = edit_distance(name, candidate);
        if (distance < best) {
            best = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

}  // namespace limn
