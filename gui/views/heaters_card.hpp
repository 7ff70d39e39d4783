#pragma once
// All heaters of the machine with what they are at and what they shall be at, the hot end that is in use,
// fans, and temperatures for a material.

#include <QLabel>
#include <QToolButton>
#include <vector>

#include "gui/views/desk.hpp"
#include "gui/views/number_field.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class HeatersCard : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit HeatersCard(Desk& desk, QWidget* parent = nullptr);

 private:
  struct HeaterRow {
    joblink::HeaterKind kind;
    std::uint32_t index;
    QLabel *name, *actual;
    NumberField* target;
  };
  struct FanRow {
    QLabel *name, *share;
  };
  void take_machine();
  void add_heater(const joblink::HeaterInfo& info);
  void have_fans(std::size_t count);
  QString heater_name(const HeaterRow& row) const;
  QString target_name(const HeaterRow& row) const;
  bool several(joblink::HeaterKind kind) const;
  const joblink::Heater* known(const HeaterRow& row) const;
  void set_target(const HeaterRow& row);
  void heat_for(const joblink::Material& material);
  void take_materials();
  void say_rows();
  void take_status();
  void take_fans();

  Desk& desk_;
  QGridLayout* heaters_grid_;
  QGridLayout* fans_grid_;
  QToolButton* materials_;
  std::vector<HeaterRow> heaters_;
  std::vector<FanRow> fans_;
};

}  // namespace kinebus::gui
