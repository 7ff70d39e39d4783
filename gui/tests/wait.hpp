#pragma once
// Waits for events, never for time: runs the event loop until something holds, or fails at a deadline.

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QDeadlineTimer>
#include <QEventLoop>
#include <functional>

namespace kinebus::gui {

inline bool wait_until(const std::function<bool()>& holds, int deadline_ms = 120'000) {
  QDeadlineTimer deadline(deadline_ms);
  while (!holds()) {
    if (deadline.hasExpired()) return false;
    QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents, 50);
  }
  return true;
}

}  // namespace kinebus::gui
