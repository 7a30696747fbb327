// Functions of program.cpp that are JavaScript. They run on the thread that has made the instance.
mergeInto(LibraryManager.library, {
  lamella_ended__proxy: 'async',
  lamella_ended__sig: 'vii',
  lamella_ended: function (code, atWork) {
    Module['ended'](code, atWork !== 0);
  },
  // Calls at the same time may share processors, so the caller gives their number.
  emscripten_num_logical_cores__proxy: 'sync',
  emscripten_num_logical_cores__sig: 'i',
  emscripten_num_logical_cores: function () {
    return Module['processors'] || 1;
  },
});
