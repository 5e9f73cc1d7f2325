//! The page in a browser, if there is one: the effect of clicks and pointer.

use std::path::Path;
use std::process::Command;

use super::page::{page_of, two};

/// The expectations on the page, and a report in its title.
const SCRIPT: &str = r##"
const found = [];
const expect = (what, holds) => { if (!holds) found.push(what); };
addEventListener("load", () => {
  const one = (selector, root = document) => root.querySelector(selector);
  const study = document.getElementById("good-1.0");
  expect("a link unfolds", study.open);
  const first = () => one(".overview tbody tr[data-study]").dataset.study;
  one(".overview thead button").click();
  const shown = () => [...document.querySelectorAll("tr.group")].filter(row => row.offsetHeight > 0).length;
  expect("sorted by name", first() === "bad");
  expect("no headings among sorted rows", shown() === 0);
  one(".overview thead button").click();
  expect("sorted the other way round", first() === "good-1.0");
  one(".overview thead button").click();
  expect("as it was", first() === "bad" && shown() === 2);
  one(".controls select").value = "fail";
  one(".controls select").dispatchEvent(new Event("input"));
  expect("filtered", study.hidden && !document.getElementById("bad").hidden);
  expect("a heading without rows is hidden", shown() === 1);
  const picture = one("#bad svg[data-plot]");
  const marker = one("[data-series='a<b'] circle", picture).getBoundingClientRect();
  const at = { clientX: marker.x + marker.width / 2, clientY: marker.y + marker.height / 2, bubbles: true };
  picture.dispatchEvent(new PointerEvent("pointermove", at));
  const said = one(".reading").textContent;
  expect("values: " + said, said.startsWith("a<b") && said.includes("mesh width h: 0.125") && said.includes("error: 0.125"));
  picture.dispatchEvent(new PointerEvent("pointerleave", at));
  expect("gone with the pointer", one(".reading").hidden);
  picture.dispatchEvent(new MouseEvent("click", at));
  picture.dispatchEvent(new PointerEvent("pointerleave", { ...at, pointerType: "touch" }));
  expect("a tap shows values", !one(".reading").hidden && one(".reading").textContent === said);
  document.body.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true }));
  expect("a tap elsewhere hides them", one(".reading").hidden);
  one("[data-entry='a<b']", picture).dispatchEvent(new MouseEvent("click"));
  expect("switched off", getComputedStyle(one("[data-series='a<b']", picture)).display === "none");
  expect("the other one stays", getComputedStyle(one("[data-series='c']", picture)).display !== "none");
  picture.dispatchEvent(new PointerEvent("pointermove", at));
  expect("nothing to say", one(".reading").hidden);
  for (const part of document.querySelectorAll("details")) part.open = true;
  expect("nothing overflows", document.documentElement.scrollWidth <= innerWidth);
  expect("nothing is loaded", performance.getEntriesByType("resource").length === 0);
  // The page measures its tables when a frame is drawn. A browser without a screen may draw none:
  // then it is started again.
  const measured = () => {
    const cut = [...document.querySelectorAll("div.scroll")].filter(box => box.scrollWidth > box.clientWidth + 1);
    const cell = one(".flow td");
    const isNamed = cell && getComputedStyle(cell, "::before").content.includes(cell.dataset.head);
    const isMeasured = cut.length === 0 && isNamed;
    document.title = found.length ? "WRONG " + found.join("; ") : isMeasured ? "RIGHT" : "not measured";
  };
  setTimeout(measured, 10000);
});
addEventListener("error", event => found.push(event.message));
addEventListener("securitypolicyviolation", event => found.push(event.violatedDirective));
"##;

#[test]
fn links_sorting_filters_and_readings_work_in_a_browser() {
    foreign_tools::needs!(CHROMIUM, TIMEOUT);
    let browser = foreign_tools::browser().expect("a browser");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("index.html");
    let page =
        page_of(&two()).replacen("<style>", &format!("<script>{SCRIPT}</script>\n<style>"), 1);
    std::fs::write(&file, page).expect("a file");
    // The browser may give up before the page has finished or a frame is drawn: so there are
    // several attempts.
    let said = (0..10).find_map(|attempt| {
        said(
            &browser,
            &file,
            &folder.path().join(format!("profile-{attempt}")),
        )
    });
    assert_eq!(said.as_deref(), Some("RIGHT"));
}

/// The title set by the page: `RIGHT`, or `WRONG` with the problem; `None` for any other title.
fn said(browser: &str, file: &Path, profile: &Path) -> Option<String> {
    // A browser that hangs is ended.
    let output = Command::new("timeout")
        .args(["60", browser])
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
        ])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ])
        .args([
            "--window-size=500,800",
            "--virtual-time-budget=15000",
            "--dump-dom",
        ])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}#good-1.0", file.display()))
        .output()
        .expect("the browser starts");
    let document = String::from_utf8_lossy(&output.stdout);
    let title = document.split_once("<title>")?.1.split_once("</title>")?.0;
    (title == "RIGHT" || title.starts_with("WRONG")).then(|| title.to_owned())
}
