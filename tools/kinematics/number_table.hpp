#pragma once
// Rows of numbers from a command line, a file or a pipe: blank or comma between them, # begins a comment, and
// a first line of column names may change their order.

#include <istream>
#include <span>
#include <string>
#include <vector>

#include "gateway/result.hpp"

namespace kinebus {

struct NumberRow {
  int line = 0;                ///< 1-based; 0: the command line
  std::vector<double> values;  ///< in the order of the columns asked for; what was left out is 0
};

struct NumberColumns {
  std::vector<std::string> names;  ///< with their units: "x_mm"
  std::size_t least = 0;           ///< so many of them must be given
  std::string list() const;        ///< "x_mm y_mm z_mm [a_deg] [c_deg]"
};

/// Errors: words with the place, what was found and what is expected.
Result<NumberRow, std::string> number_row(std::span<const std::string> words, const NumberColumns& columns);
/// `name`: what stands for the input in messages. At most 200,000 rows.
Result<std::vector<NumberRow>, std::string> number_table(std::istream& in, const std::string& name,
                                                         const NumberColumns& columns);

}  // namespace kinebus
