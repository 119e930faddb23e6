// The last line of a plug-in: MULLION_PLUGIN(MyBeam, "structure", "my_beam", "a beam of mine");. Wraps a
// Module class behind the C boundary of abi.h: no exception, vtable or C++ type crosses it.
//
// The class brings: struct Options with table() (parameters.hpp), a constructor from Options, static fields() and
// inputs() (field.hpp), and, if it offers functions by name, static constexpr functions() (module.hpp).
#pragma once

#include <mullion/sdk/module.hpp>

#include <cfenv>
#include <exception>
#include <memory>
#include <new>
#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#ifndef MULLION_PLUGIN_VERSION
#define MULLION_PLUGIN_VERSION "0.1.0"
#endif

namespace mullion::detail {

/// Round to nearest, no flush to zero: some libraries leave other modes behind, and bits would depend on who
/// was called before.
inline void reset_floating_point()
{
  std::fesetround(FE_TONEAREST);
#if defined(__x86_64__)
  _mm_setcsr(0x1f80); // the default: all exceptions masked, round to nearest, no FTZ, no DAZ
#endif
}

inline TimeStep to_step(const mullion_step& raw) { return {raw.index, raw.begin, raw.end, raw.dt, raw.iteration}; }

/// Run a body and turn whatever it throws into a status and a text.
template <class Body> std::int32_t guarded(const mullion_services* services, void* context, Body&& body) noexcept
{
  reset_floating_point();
  const auto fail = [&](Errc code, const char* text) {
    services->fail(context, static_cast<std::int32_t>(code), text);
    return static_cast<std::int32_t>(code);
  };
  try {
    body();
    return MULLION_OK;
  } catch (const Error& error) {
    return fail(error.code(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(Errc::memory, "out of memory");
  } catch (const std::exception& error) {
    return fail(Errc::internal, error.what());
  } catch (...) {
    return fail(Errc::internal, "threw something that is no std::exception");
  }
}

template <class T>
concept OffersFunctions = requires
{
  T::functions();
};

template <class Owner> double invoke(Owner& owner, double (Owner::*member)(), const double*)
{
  return (owner.*member)();
}
template <class Owner, class... Arguments>
double invoke(Owner& owner, double (Owner::*member)(Arguments...), const double* values)
{
  return [&]<std::size_t... I>(std::index_sequence<I...>) { return (owner.*member)(values[I]...); }
  (std::index_sequence_for<Arguments...>{});
}
template <class Member> struct Arity;
template <class Owner, class... A> struct Arity<double (Owner::*)(A...)> {
  static constexpr std::uint32_t arguments = sizeof...(A), results = 1;
};
template <class Owner> struct Arity<void (Owner::*)(const TimeStep&)> {
  static constexpr std::uint32_t arguments = 0, results = 0;
};

/// The C entries of one Module class.
template <class T> struct PluginOf {
  struct Instance {
    const mullion_services* services;
    void* context;
    std::unique_ptr<T> module;
  };
  template <class Body> static std::int32_t run(void* raw, Body&& body)
  {
    auto& instance = *static_cast<Instance*>(raw);
    return guarded(instance.services, instance.context, [&] { body(*instance.module); });
  }

  static std::int32_t create(void* context, const mullion_services* services, const mullion_value* values, void** out)
  {
    return guarded(services, context, [&] {
      auto instance = std::make_unique<Instance>(Instance{services, context, nullptr});
      instance->module = std::make_unique<T>(read_options<typename T::Options>(values));
      instance->module->bind_services(Services(services, context));
      *out = instance.release();
    });
  }
  static void destroy(void* instance) { delete static_cast<Instance*>(instance); }
  static std::int32_t define(void* instance, const mullion_step* initial)
  {
    return run(instance, [&](T& module) { module.define(to_step(*initial)); });
  }
  static std::int32_t attach(void* instance)
  {
    return run(instance, [&](T& module) { module.attach(); });
  }
  static std::int32_t start(void* instance, const mullion_step* initial)
  {
    return run(instance, [&](T& module) { module.start(to_step(*initial)); });
  }
  static std::int32_t step(void* instance, const mullion_step* step)
  {
    return run(instance, [&](T& module) { module.step(to_step(*step)); });
  }
  static std::int32_t call(void* instance, std::uint32_t index, const mullion_step* step,
                           [[maybe_unused]] const double* arguments, [[maybe_unused]] double* results)
  {
    return run(instance, [&]([[maybe_unused]] T& module) {
      bool is_known = false;
      if constexpr (OffersFunctions<T>) {
        std::uint32_t i = 0;
        const auto try_one = [&](const auto& function) {
          if (i++ != index) return;
          is_known = true;
          using Member = std::remove_cvref_t<decltype(function.member)>;
          if constexpr (Arity<Member>::results == 0) (module.*function.member)(to_step(*step));
          else results[0] = invoke(module, function.member, arguments);
        };
        std::apply([&](const auto&... function) { (try_one(function), ...); }, T::functions());
      }
      MULLION_ASSERT(is_known, "no function number {}", index);
    });
  }

  static std::vector<mullion_field_spec> field_specs()
  {
    static const std::vector<FieldSpec> fields = T::fields();
    std::vector<mullion_field_spec> out;
    for (const auto& f : fields)
      out.push_back({f.window.c_str(), f.name.c_str(), f.unit.c_str(), f.meaning.c_str(),
                     static_cast<std::uint32_t>(f.location), f.components, static_cast<std::uint32_t>(f.role),
                     static_cast<std::uint32_t>(f.nature), static_cast<std::uint32_t>(f.carry), f.scalar_type});
    return out;
  }
  static std::vector<mullion_input_spec> input_specs()
  {
    static const std::vector<InputSpec> inputs = T::inputs();
    std::vector<mullion_input_spec> out;
    for (const auto& f : inputs)
      out.push_back({f.window.c_str(), f.name.c_str(), f.unit.c_str(), f.meaning.c_str(),
                     static_cast<std::uint32_t>(f.location), f.components, static_cast<std::uint32_t>(f.nature),
                     f.is_required ? 1u : 0u});
    return out;
  }
  static std::vector<mullion_function_spec> function_specs()
  {
    std::vector<mullion_function_spec> out;
    if constexpr (OffersFunctions<T>)
      std::apply(
          [&](const auto&... f) {
            (out.push_back({f.name, f.meaning, f.writes, Arity<std::remove_cvref_t<decltype(f.member)>>::arguments,
                            Arity<std::remove_cvref_t<decltype(f.member)>>::results}),
             ...);
          },
          T::functions());
    return out;
  }

  static const void* entry()
  {
    static const auto fields = field_specs();
    static const auto inputs = input_specs();
    static const auto functions = function_specs();
    const auto& parameters = parameter_specs<typename T::Options>();
    static const mullion_module module{parameters.data(),
                                       fields.data(),
                                       inputs.data(),
                                       functions.data(),
                                       static_cast<std::uint32_t>(parameters.size()),
                                       static_cast<std::uint32_t>(fields.size()),
                                       static_cast<std::uint32_t>(inputs.size()),
                                       static_cast<std::uint32_t>(functions.size()),
                                       &create,
                                       &destroy,
                                       &define,
                                       &attach,
                                       &start,
                                       &step,
                                       &call};
    return &module;
  }
};

} // namespace mullion::detail

/// Export a Module class as a plug-in. `kind` is fluid, structure, mesh_motion or transfer.
#define MULLION_PLUGIN(Class, kind, name, summary)                                                                     \
  extern "C" __attribute__((visibility("default"))) const mullion_header mullion_plugin;                               \
  extern "C" constexpr mullion_header mullion_plugin = {                                                               \
      MULLION_MAGIC, MULLION_ABI, sizeof(mullion_header),                                                              \
      kind,          name,        MULLION_PLUGIN_VERSION,                                                              \
      summary,       nullptr,     &::mullion::detail::PluginOf<Class>::entry}
