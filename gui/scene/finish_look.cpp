#include "gui/scene/finish_look.hpp"

namespace kinebus::gui {

Look look_of(Finish finish) {
  switch (finish) {
    case Finish::kFixed:
      return {{0.72F, 0.74F, 0.77F}, {0.30F, 0.33F, 0.37F}, 0.10F, 0};
    case Finish::kRail:
      return {{0.82F, 0.84F, 0.87F}, {0.58F, 0.62F, 0.67F}, 0.45F, 0};
    case Finish::kCarriage:
      return {{0.06F, 0.52F, 0.62F}, {0.07F, 0.58F, 0.68F}, 0.25F, 0};
    case Finish::kLeg:
      return {{0.20F, 0.22F, 0.25F}, {0.42F, 0.46F, 0.51F}, 0.30F, 0};
    case Finish::kHolder:
      return {{0.48F, 0.51F, 0.55F}, {0.42F, 0.45F, 0.50F}, 0.40F, 0};
    case Finish::kPlatform:
      return {{0.62F, 0.65F, 0.69F}, {0.36F, 0.40F, 0.45F}, 0.15F, 0};
    case Finish::kTable:
      return {{0.28F, 0.31F, 0.35F}, {0.24F, 0.27F, 0.31F}, 0.12F, 0};
    case Finish::kTool:
      return {{0.86F, 0.68F, 0.30F}, {0.80F, 0.62F, 0.27F}, 0.60F, 0};
    case Finish::kHot:
      return {{0.93F, 0.42F, 0.16F}, {0.96F, 0.44F, 0.16F}, 0.20F, 0.35F};
    case Finish::kMark:
      return {{0.95F, 0.61F, 0.13F}, {0.95F, 0.61F, 0.13F}, 0.10F, 0.15F};
    case Finish::kNear:
      return {{0.86F, 0.13F, 0.17F}, {0.92F, 0.17F, 0.20F}, 0.20F, 0.25F};
  }
  return {};
}

}  // namespace kinebus::gui
