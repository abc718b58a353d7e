// The functions of page.h as a script calls them: texts for texts, numbers as arrays.

// The lab of a module that startImpactlab() has started.
export function labOf(module) {
  function read(pointer) {
    if (pointer === 0) {
      throw new Error("there is no memory for the answer");
    }
    return module.UTF8ToString(pointer);
  }

  // Calls a function with texts that lie in the module's memory for so long.
  function withTexts(texts, call) {
    const places = texts.map((text) => {
      const size = module.lengthBytesUTF8(text) + 1;
      const place = module._malloc(size);
      if (place === 0) {
        throw new Error("there is no memory for the text");
      }
      module.stringToUTF8(text, place, size);
      return place;
    });
    try {
      return call(...places);
    } finally {
      places.forEach(module._free);
    }
  }

  // A copy of numbers in the module's memory.
  function numbers(pointer, count) {
    return module.HEAPF64.slice(pointer / 8, pointer / 8 + count);
  }

  return {
    tables: () => JSON.parse(read(module._page_tables())),
    read: (name, text) => JSON.parse(read(withTexts([name, text], module._page_read))),
    // `changes` has a value for each path
    change: (changes) => {
      const lines = Object.entries(changes).map(([path, value]) => `${path}=${value}`);
      return JSON.parse(read(withTexts([lines.join("\n")], module._page_change)));
    },
    yaml: () => read(module._page_yaml()),
    csv: () => read(module._page_csv()),
    run: (seconds, withRows) => read(module._page_run(seconds, withRows ? 1 : 0)),
    account: () => JSON.parse(read(module._page_account())),
    predictions: () => read(module._page_predictions()),
    rows: () => module._page_rows(),
    freedoms: () => module._page_freedoms(),
    angles: () => numbers(module._page_angles(), module._page_rows() * module._page_freedoms()),
    signal: (name) => {
      const place = withTexts([name], module._page_signal);
      if (place === 0) {
        throw new Error(`there is no signal '${name}'`);
      }
      return numbers(place, module._page_rows());
    },
  };
}
