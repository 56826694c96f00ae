#include "ecs/base/bucket_table.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>

namespace limn::bucket_table_test {

TEST_CASE(
    "bucket table: what was added is found, what was removed is not"
    * technique("engine.hash-bucket")) {
    BucketTable<int, char> table(7);
    CHECK(table.add(11, 'A'));
    CHECK(table.add(12, 'B'));
    REQUIRE(table.find(12) != nullptr);
    CHECK(*table.find(12) == 'B');
    CHECK_FALSE(table.add(12, 'C'));  // rejected
    CHECK(*table.find(12) == 'B');
    CHECK(table.remove(12));
    CHECK(table.find(12) == nullptr);
    CHECK_FALSE(table.remove(12));
    CHECK(*table.find(11) == 'A');
}

TEST_CASE("bucket table: names are sums of characters; anagrams share a slot, and each is found") {
    CHECK(character_sum("object1") == 680);
    CHECK(character_sum("object2") == 681);
    CHECK(character_sum("Catfish") == 706);
    BucketTable<std::string, int> table(101, NameHash::CharacterSum);
    CHECK(table.add("stop", 1));
    CHECK(table.add("post", 2));
    CHECK(table.add("spot", 3));
    CHECK(table.slot("stop") == table.slot("post"));
    CHECK(table.longest_slot() == 3);
    CHECK(*table.find("post") == 2);
    std::size_t compared = 0;
    CHECK(*table.find("spot", &compared) == 3);
    CHECK(compared == 3);
    CHECK(table.find("tops") == nullptr);
    BucketTable<std::string, int> other(101);
    CHECK(other.slot("stop") != other.slot("post"));
}

TEST_CASE("bucket table: a prime number of slots spreads keys that a power of two does not") {
    BucketTable<int, int> even(16);
    BucketTable<int, int> prime(17);
    for (int i = -8; i < 8; ++i) {
        CHECK(even.add(16 * i, i));
        CHECK(prime.add(16 * i, i));
        CHECK(even.slot(16 * i) == 0);
    }
    CHECK(even.longest_slot() == 16);
    CHECK(prime.longest_slot() == 1);
    CHECK(slot_of(-1, 17) == 16);
    CHECK(*prime.find(-128) == -8);
}

TEST_CASE(
    "probe table: a step that is not coprime does not reach all slots"
    * technique("engine.hash-probe")) {
    for (const std::size_t step :
         {std::size_t{1}, std::size_t{7}, std::size_t{2}, std::size_t{13}}) {
        ProbeTable table(26, step);
        std::size_t added = 0;
        for (int i = 0; i < 26; ++i) {
            added += table.add(std::to_string(i), 3).has_value() ? 1 : 0;
        }
        CHECK(added == (step == 2 ? 13u : step == 13 ? 2u : 26u));
        CHECK_FALSE(table.add("more", 3).has_value());  // full, and it ends
        CHECK_FALSE(table.search("missing", 3).has_value());
        CHECK_FALSE(table.add("0", 3).has_value());  // exists
    }
}

}  // namespace limn::bucket_table_test
