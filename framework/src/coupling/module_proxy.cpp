// The driver's handles: each is an id and a pointer to the session that does the work.
#include <mullion/coupling/module_proxy.hpp>

#include "run/session.hpp"

namespace mullion {

using shm::Operation;

void ModuleProxy::start(const TimeStep& initial) const
{
  session_->begin(module_, Operation::start, 0, initial, initial.end);
  session_->await(module_);
}
void ModuleProxy::step(const TimeStep& step) const { this->step(step, step.end); }
void ModuleProxy::step(const TimeStep& step, double stamp) const
{
  session_->begin(module_, Operation::step, 0, step, stamp);
  session_->await(module_);
}
void ModuleProxy::begin_step(const TimeStep& step) const
{
  session_->begin(module_, Operation::step, 0, step, step.end);
}
void ModuleProxy::await() const { session_->await(module_); }

void Action::operator()(const TimeStep& step, double stamp) const
{
  session_->begin(module_, Operation::call, function_, step, stamp);
  session_->await(module_);
}

double Query::ask(const TimeStep& step, const double* values, std::uint32_t n) const
{
  MULLION_REQUIRE(n == n_arguments_, Errc::config, "a driver called a function of {} numbers with {}", n_arguments_, n);
  session_->begin(module_, Operation::call, function_, step, step.end, values, n);
  session_->await(module_);
  return session_->result(module_);
}

ConstArray ModuleField::now() const { return session_->read({window_, field_}, 0); }
ConstArray ModuleField::committed(int back) const { return session_->read({window_, field_}, back); }
ConstArray ReceivedField::committed(int back) const { return session_->read({window_, field_}, back); }
Array ReceivedField::writable() const { return session_->write({window_, field_}); }
void ReceivedField::stamp(double time, std::uint32_t kind) const { session_->stamp({window_, field_}, time, kind); }
Array DriverField::now() const { return session_->write({window_, field_}); }
ConstArray DriverField::committed(int back) const { return session_->read({window_, field_}, back); }

ModuleProxy Coupling::module(const std::string& instance) const { return {session_, session_->find_module(instance)}; }
Action Coupling::action(const std::string& instance, const std::string& function) const
{
  const auto module = session_->find_module(instance);
  return {session_, module, session_->find_function(module, function, 0, 0)};
}
Query Coupling::query(const std::string& instance, const std::string& function, std::uint32_t n_arguments) const
{
  const auto module = session_->find_module(instance);
  return {session_, module, session_->find_function(module, function, n_arguments, 1), n_arguments};
}
ModuleField Coupling::field(const std::string& port, std::uint32_t pane) const
{
  const auto at = session_->find_field(port, false, pane);
  session_->exchange(at);
  return {session_, at.window, at.field};
}
ReceivedField Coupling::received(const std::string& port, std::uint32_t pane) const
{
  const auto at = session_->find_field(port, true, pane);
  return {session_, at.window, at.field};
}
Pane Coupling::pane(const std::string& window, std::uint32_t pane) const { return session_->pane_of(window, pane); }
void Coupling::warn(const std::string& text) const { session_->warn(text); }
DriverField Coupling::state(const std::string& name) const
{
  const auto at = session_->find_state(name);
  return {session_, at.window, at.field};
}

} // namespace mullion
