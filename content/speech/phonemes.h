#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace limn {

/// Visually distinct mouth shapes (face.viseme), in the order of MPEG-4.
enum class Viseme : std::uint8_t {
    Silence,
    P,   ///< p b m: lips shut
    F,   ///< f v: lower lip at the upper teeth
    Th,  ///< th dh
    T,   ///< t d
    K,   ///< k g
    Ch,  ///< ch j sh zh
    S,   ///< s z
    N,   ///< n l
    R,
    A,
    E,
    I,
    O,
    U,
};

inline constexpr std::size_t kVisemes = 15;

/// A sound of English, with its duration in fluent speech: D. Klatt, "Linguistic uses of segmental
/// duration in English", 1976; T. Crystal and A. House, 1988.
struct Phoneme {
    std::string_view name;  ///< ARPAbet, in lower case; diphthongs are two phonemes
    std::string_view ipa;   ///< its symbols, between spaces
    Viseme viseme = Viseme::Silence;
    float duration = 0.0f;  ///< [s]
    bool is_vowel = false;
};

/// All of them. The first is silence, "sil".
[[nodiscard]] std::span<const Phoneme> phonemes();

/// Index of the phoneme of that name, or -1.
[[nodiscard]] int find_phoneme(std::string_view name);

}  // namespace limn
