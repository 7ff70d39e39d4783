#pragma once
// Jobs for pictures and tests, made on the spot.

#include <QByteArray>

namespace kinebus::gui {

/// A vase with a wavy wall, three rings and a filled floor: `layers` of 0.25 mm, about 240 lines each.
QByteArray vase_job(int layers);
/// A vase that leaves the reach of the machine: what the pre-flight finds.
QByteArray wrong_job();
/// At least `lines` short lines: a tall part of many rings.
QByteArray long_job(int lines);

}  // namespace kinebus::gui
