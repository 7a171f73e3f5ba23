// For the leak sanitizer, which calls this: OpenMM loses what it has built so far when a Context's constructor throws.
extern "C" char const* __lsan_default_suppressions();
extern "C" char const* __lsan_default_suppressions() { return "leak:OpenMM::Context::Context\n"; }
