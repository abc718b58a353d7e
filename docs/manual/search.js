// The search of the manual: every heading with the text below it, found by all the words typed;
// a word in the heading counts most. Nothing is fetched.
(function () {
    const MOST = 40, BEFORE = 40, AFTER = 90;
    const words = document.getElementById("words"), found = document.getElementById("found");
    const contents = document.getElementById("contents");

    // one entry a heading; tables, lists and code below it are its text
    const entries = [];
    for (const section of document.querySelectorAll("main > section")) {
        let entry = null;
        for (const node of section.children) {
            if (/^H[1-6]$/.test(node.tagName)) {
                entry = { id: node.id || section.id, title: node.textContent, text: "" };
                entry.chapter = section.querySelector("h1, h2").textContent;
                entries.push(entry);
            } else if (entry) {
                entry.text += " " + node.textContent.replace(/\s+/g, " ");
            }
        }
    }

    function count(text, word) {
        return text.split(word).length - 1;
    }

    // what has all words, the best first
    function search(query) {
        const all = query.toLowerCase().split(/\s+/).filter(Boolean), hits = [];
        for (const entry of all.length ? entries : []) {
            const title = entry.title.toLowerCase(), text = entry.text.toLowerCase();
            const parts = all.map((w) => 20 * count(title, w) + Math.min(count(text, w), 10));
            if (parts.every((part) => part > 0)) {
                const at = Math.max(0, text.indexOf(all[0]) - BEFORE);
                const score = parts.reduce((a, b) => a + b, 0);
                hits.push({ entry, score, snippet: entry.text.substr(at, BEFORE + AFTER) });
            }
        }
        return hits.sort((a, b) => b.score - a.score).slice(0, MOST);
    }

    function show() {
        const hits = search(words.value), typed = words.value.trim() !== "";
        found.replaceChildren(...hits.map((hit) => {
            const item = document.createElement("li"), link = document.createElement("a");
            const text = document.createElement("small");
            link.href = "#" + hit.entry.id;
            link.textContent = hit.entry.chapter === hit.entry.title
                ? hit.entry.title : hit.entry.chapter + ": " + hit.entry.title;
            text.textContent = hit.snippet;
            item.append(link, text);
            return item;
        }));
        if (typed && hits.length === 0) {
            found.textContent = "nothing has all these words";
        }
        found.hidden = !typed;
        contents.hidden = typed;
    }

    words.addEventListener("input", show);
    document.addEventListener("keydown", (event) => {
        if (event.key === "/" && document.activeElement !== words) {
            event.preventDefault();
            words.focus();
        }
    });

    // manual.html?words opens with them searched for
    if (location.search.length > 1) {
        words.value = decodeURIComponent(location.search.slice(1).replace(/\+/g, " "));
        show();
    }
})();
