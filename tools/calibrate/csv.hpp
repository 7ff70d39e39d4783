#pragma once
// Measurements as comma-separated values whose header names the units:
// "joint,commanded_mm,measured_um,direction".

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/result.hpp"

namespace kinebus {

struct CsvError {
  int line = 0;  ///< 1-based; 0: the file as a whole
  std::string what;
};
std::string to_string(const CsvError& error, std::string_view file);

/// Numbers come out in mm and rad: a column "z_um" is found as "z". Lines that begin with # are comments.
class Csv {
 public:
  static Result<Csv, CsvError> parse(std::string_view text);

  std::size_t rows() const { return cells_.size(); }
  int line(std::size_t row) const { return lines_[row]; }
  bool has(std::string_view column) const { return find(column).has_value(); }
  /// A length or angle: column `name`_um, _mm, _m, _deg, _mrad or _rad. Without a unit: error.
  Result<double, CsvError> quantity(std::size_t row, std::string_view name) const;
  Result<double, CsvError> plain(std::size_t row, std::string_view name) const;  ///< a number without unit
  std::string word(std::size_t row, std::string_view name) const;                ///< empty: no such column

 private:
  struct Column {
    std::string name;
    double unit = 0;  ///< 0: none
  };
  std::optional<std::size_t> find(std::string_view name) const;
  Result<double, CsvError> number(std::size_t row, std::size_t column) const;

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> cells_;
  std::vector<int> lines_;
};

}  // namespace kinebus
