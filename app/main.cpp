#include <exception>
#include <iostream>

#include "app/errors.h"
#include "app/headless.h"
#include "app/options.h"
#include "app/scene_file.h"
#include "app/window.h"

namespace {

int run(const app::Options& options) {
  app::Scene scene = app::sceneFromOptions(options);
  return options.headless ? app::runHeadless(std::move(scene), options) : app::runWindow(std::move(scene), options);
}

int fail(const std::exception& fault, int exit_code) {
  std::cerr << "hairmesh: " << fault.what() << "\n";
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  app::Options options;
  int exit_code = app::kExitFine;
  try {
    if (!app::parseOptions(argc, argv, options, exit_code)) return exit_code;
    return run(options);
  } catch (const app::UsageError& fault) {
    return fail(fault, app::kExitUsage);
  } catch (const app::InputError& fault) {
    return fail(fault, app::kExitBadInput);
  } catch (const app::ContextError& fault) {
    return fail(fault, app::kExitNoContext);
  } catch (const std::exception& fault) {
    return fail(fault, app::kExitFault);
  }
}
