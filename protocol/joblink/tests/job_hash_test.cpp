#include "protocol/joblink/job_hash.hpp"

#include <gtest/gtest.h>

#include "protocol/joblink/sha256.hpp"

namespace kinebus::joblink {
namespace {

// Values that `xxh128sum` (Debian's xxhash 0.8.1) prints.
TEST(JobHash, IsThatOfXxh128sum) {
  EXPECT_EQ(to_hex(job_hash_of("")), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(to_hex(job_hash_of("G1 X10 F600\n")), "def13fab4a1e8a1d5d84df46cdf6c573");
  EXPECT_EQ(to_hex(job_hash_of(std::string(100'000, 'x'))), "0fe996a84987456bd8b99a30e426ac41");
}

TEST(JobHash, IsTheSameHoweverTheTextIsCut) {
  std::string text(300'000, '\0');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(i * i >> 7U);
  for (const std::size_t piece : {1UL, 239UL, 4096UL, 131'000UL}) {
    JobHash sum;
    for (std::size_t i = 0; i < text.size(); i += piece) sum.add(std::string_view(text).substr(i, piece));
    EXPECT_EQ(sum.finish(), job_hash_of(text)) << "pieces of " << piece;
  }
}

}  // namespace
}  // namespace kinebus::joblink
