// Makes stores of the guest fast. Unicorn 2.0.1 looks at every store for code that it may change, by locking
// the page in a balanced tree made for that one store: 70 ns and more, most of the emulation's time. The
// linker puts these in place of the three functions (--wrap, see CMakeLists.txt). So code in RAM may be
// written only before it is first run or over a reset, where CortexM4 throws all translations away; stores to
// flash go another way (CortexM4).

// NOLINTBEGIN(bugprone-reserved-identifier): the linker looks for these names.
extern "C" {

void* __wrap_page_collection_lock_arm(void*, unsigned long, unsigned long);
void __wrap_page_collection_unlock_arm(void*);
void __wrap_tb_invalidate_phys_page_fast_arm(void*, void*, unsigned long, int, unsigned long);

void* __wrap_page_collection_lock_arm(void*, unsigned long, unsigned long) {
  return nullptr;
}
void __wrap_page_collection_unlock_arm(void*) {}
void __wrap_tb_invalidate_phys_page_fast_arm(void*, void*, unsigned long, int, unsigned long) {}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier)
