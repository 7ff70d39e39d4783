#pragma once
// Registers of a Unicorn engine, singly and many at once. For the processor's own files only.

#include <unicorn/unicorn.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace kinebus::emulator {

inline uc_engine* engine(void* uc) {
  return static_cast<uc_engine*>(uc);
}

inline std::uint32_t read_register(void* uc, int id) {
  std::uint32_t value = 0;
  uc_reg_read(engine(uc), id, &value);
  return value;
}

inline void write_register(void* uc, int id, std::uint32_t value) {
  uc_reg_write(engine(uc), id, &value);
}

template <std::size_t N>
void read_registers(void* uc, std::array<int, N>& ids, std::array<std::uint32_t, N>& values) {
  std::array<void*, N> pointers{};
  for (std::size_t i = 0; i < N; ++i) pointers[i] = &values[i];
  uc_reg_read_batch(engine(uc), ids.data(), pointers.data(), static_cast<int>(N));
}

template <std::size_t N>
void write_registers(void* uc, std::array<int, N>& ids, std::array<std::uint32_t, N>& values) {
  std::array<void*, N> pointers{};
  for (std::size_t i = 0; i < N; ++i) pointers[i] = &values[i];
  uc_reg_write_batch(engine(uc), ids.data(), pointers.data(), static_cast<int>(N));
}

inline void check(uc_err error, const char* what) {
  if (error != UC_ERR_OK) throw std::runtime_error(std::string(what) + ": " + uc_strerror(error));
}

}  // namespace kinebus::emulator
