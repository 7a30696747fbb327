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
  // Emscripten 3.1.6 passes on the lower 32 bits of offsets and lengths, as signed numbers: it refuses what is beyond 2 GiB,
  // and beyond 4 GiB it would read and write elsewhere.
  $wideOffsets__deps: ['$SYSCALLS'],
  $wideOffsets__postset: 'SYSCALLS.get64 = wideOffsets;',
  $wideOffsets: function (low, high) {
    return high * 4294967296 + (low >>> 0);
  },
  $transferAt__deps: ['$SYSCALLS', '$FS', '$wideOffsets'],
  $transferAt: function (act, fd, vectors, count, low, high, done) {
    try {
      HEAPU32[done >>> 2] = SYSCALLS[act](SYSCALLS.getStreamFromFD(fd), vectors, count, wideOffsets(low, high));
      return 0;
    } catch (error) {
      if (!(error instanceof FS.ErrnoError)) throw error;
      return error.errno;
    }
  },
  fd_pread__deps: ['$transferAt'],
  fd_pread__proxy: 'sync',
  fd_pread__sig: 'iiiiiii',
  fd_pread: function (fd, vectors, count, low, high, done) {
    return transferAt('doReadv', fd, vectors, count, low, high, done);
  },
  fd_pwrite__deps: ['$transferAt'],
  fd_pwrite__proxy: 'sync',
  fd_pwrite__sig: 'iiiiiii',
  fd_pwrite: function (fd, vectors, count, low, high, done) {
    return transferAt('doWritev', fd, vectors, count, low, high, done);
  },
});
