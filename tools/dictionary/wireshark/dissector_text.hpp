#pragma once
// The part of the dissector that is no table: dissector.lua, made part of the program by CMake.

namespace kinebus {

extern const char* const kDissectorText;

}  // namespace kinebus
