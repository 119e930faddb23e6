#include "legality.hpp"

#include "words.hpp"

namespace mullion::surface {

namespace {

const char* name_of(Quantity quantity)
{
  switch (quantity) {
  case Quantity::traction: return "traction";
  case Quantity::load: return "load";
  case Quantity::velocity: return "velocity";
  case Quantity::displacement: return "displacement";
  }
  return "unknown quantity";
}

bool is_motion(Quantity quantity) { return quantity == Quantity::velocity || quantity == Quantity::displacement; }

std::string complaint_about_nature(const char* side, const Transferred& field)
{
  const auto fitting = field.quantity == Quantity::load ? Nature::extensive : Nature::intensive;
  if (field.nature == fitting) return "";
  const auto word = [](Nature nature) { return nature == Nature::intensive ? "intensive" : "extensive"; };
  return words("the ", side, " is an ", word(field.nature), " ", name_of(field.quantity), "; a ",
               name_of(field.quantity), " is ", word(fitting));
}

} // namespace

std::string complaint_about_transfer(const Transferred& source, const Transferred& target, bool has_recovery)
{
  if (auto complaint = complaint_about_nature("source", source); !complaint.empty()) return complaint;
  if (auto complaint = complaint_about_nature("target", target); !complaint.empty()) return complaint;
  if (is_motion(source.quantity) || is_motion(target.quantity)) {
    if (source.quantity == target.quantity) return "";
    return words("a ", name_of(source.quantity), " cannot become a ", name_of(target.quantity), "; a ",
                 name_of(is_motion(source.quantity) ? source.quantity : target.quantity),
                 " goes to or comes from the same quantity only");
  }
  if (target.quantity == Quantity::load || has_recovery) return "";
  return words("a ", name_of(source.quantity), " arrives as loads, the target takes a traction; turn recovery on, or ",
               "let the target take loads");
}

} // namespace mullion::surface
