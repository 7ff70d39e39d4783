#pragma once
// Waits for events, never for time: runs the event loop until something holds, or fails at a deadline.

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QEventLoop>
#include <algorithm>
#include <functional>

namespace kinebus::gui {

/// What a turn of the event loop counts for at most: a computer that stands still uses up no patience.
constexpr qint64 kLongestTurn_ms = 200;

inline bool wait_until(const std::function<bool()>& holds, qint64 patience_ms = 120'000) {
  QElapsedTimer turn;
  while (!holds()) {
    if (patience_ms <= 0) return false;
    turn.start();
    QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents, 50);
    patience_ms -= std::min(turn.elapsed(), kLongestTurn_ms);
  }
  return true;
}

}  // namespace kinebus::gui
