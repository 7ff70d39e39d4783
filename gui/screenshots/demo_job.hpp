#pragma once
// Jobs for pictures and tests, made on the spot.

#include <QByteArray>

namespace kinebus::gui {

/// A vase with a wavy wall of `walls` rings and a filled floor; 80 lines a ring.
QByteArray vase_job(int layers, int walls, double layer_mm);
/// A vase that leaves the reach of the machine: what the pre-flight finds.
QByteArray wrong_job();
/// At least `lines` short lines: a tall part of many rings.
QByteArray long_job(int lines);

}  // namespace kinebus::gui
