"use strict";
// Filter, folding, links into the page, print. Everything can be read without.
(() => {
  const form = document.querySelector(".controls");
  const [search, verdict] = [form.querySelector("input"), form.querySelector("select")];
  const count = form.querySelector("output");
  const rows = new Map([...document.querySelectorAll("tr[data-study]")].map(row => [row.dataset.study, row]));
  const studies = [...document.querySelectorAll("details.study")];
  // Tables and captions count, the texts of pictures do not: every picture says "dimensionless".
  const words = new Map(studies.map(study => {
    const parts = [...study.querySelectorAll("summary, p, th, td")].map(part => part.textContent);
    return [study, [...parts, rows.get(study.id).textContent].join(" ").toLowerCase()];
  }));

  const groups = [...document.querySelectorAll("tr.group")];
  // Taken once: sorting moves the rows.
  const members = new Map(groups.map(group => {
    const rows = [];
    for (let row = group.nextElementSibling; row?.dataset.study; row = row.nextElementSibling) rows.push(row);
    return [group, rows];
  }));

  const filter = () => {
    const wanted = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const study of studies) {
      const fits = (!verdict.value || study.dataset.verdict === verdict.value)
        && wanted.every(word => words.get(study).includes(word));
      study.hidden = rows.get(study.id).hidden = !fits;
      shown += fits;
    }
    for (const group of groups) group.hidden = members.get(group).every(row => row.hidden);
    count.textContent = shown === studies.length ? "" : `${shown} of ${studies.length} studies`;
  };
  search.addEventListener("input", filter);
  verdict.addEventListener("input", filter);
  form.addEventListener("submit", event => event.preventDefault());
  form.hidden = false;

  for (const button of form.querySelectorAll("[data-unfold]")) {
    button.addEventListener("click", () => {
      for (const study of studies) study.open = button.dataset.unfold === "true";
    });
  }

  // A link to a study opens it, even where the filter has hidden it.
  const follow = () => {
    const study = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!study) return;
    if (study.hidden) {
      search.value = verdict.value = "";
      filter();
    }
    study.open = true;
    study.scrollIntoView();
  };
  addEventListener("hashchange", follow);
  follow();
  // The same link once more is no change of the address.
  document.addEventListener("click", event => {
    const link = event.target.closest?.("a[href^='#']");
    if (link && link.hash === location.hash) follow();
  });

  // A table that is wider than its box flows, its cells named; it is measured anew whenever its box gets another width.
  const fit = box => {
    box.classList.remove("flow");
    box.classList.toggle("flow", box.scrollWidth > box.clientWidth + 1);
  };
  const boxes = [...document.querySelectorAll(".scroll")].filter(box => box.querySelector("table:not(.overview)"));
  const known = new Map();
  const watch = new ResizeObserver(entries => {
    for (const { target, contentRect: { width } } of entries) {
      // In the next frame: a box that changes while it is being observed would be reported as an error.
      if (known.get(target) !== width) requestAnimationFrame(() => fit(target));
      known.set(target, width);
    }
  });
  for (const box of boxes) {
    const heads = [...box.querySelectorAll("thead th")].map(head => head.textContent);
    for (const row of box.querySelectorAll("tbody tr")) {
      [...row.children].forEach((cell, k) => { cell.dataset.head = heads[k]; });
    }
    watch.observe(box);
  }

  // Nothing can be unfolded on paper.
  let folded = [];
  addEventListener("beforeprint", () => {
    folded = [...document.querySelectorAll("details:not([open])")];
    for (const part of folded) part.open = true;
  });
  addEventListener("afterprint", () => {
    for (const part of folded) part.open = false;
  });
})();
