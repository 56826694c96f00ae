#pragma once

#include <span>
#include <string_view>

namespace limn {

/// `letters` of a word between `left` and `right` sound as `sounds`. Patterns: a letter is itself,
/// ' ' the edge of the word, # one or more vowels, : any number of consonants, ^ one consonant,
/// + one of e i y, % one of the endings e ed er es est ing ely, . a voiced consonant, & a sibilant.
struct SpellingRule {
    std::string_view left;
    std::string_view letters;
    std::string_view right;
    std::string_view sounds;  ///< names of phonemes, separated by spaces; ' after a vowel: stressed
};

/// Rules for words that begin with a letter; the first that fits counts. One without patterns ends
/// the list of each letter, so that something always fits.
[[nodiscard]] std::span<const SpellingRule> spelling_rules(char letter);

/// The sounds of a frequent word that no rule gets right, or "".
[[nodiscard]] std::string_view sounds_of_word(std::string_view word);

}  // namespace limn
