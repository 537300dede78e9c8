// What is shown stands behind the # of the address, so that a link shows what one saw.

export const address = new URLSearchParams(location.hash.slice(1));

let waiting = 0;

/// Changes what the address says; null removes a key. The history keeps one entry for all of it.
export function setAddress(changes) {
  for (const [key, value] of Object.entries(changes)) {
    if (value === null) address.delete(key);
    else address.set(key, String(value));
  }
  // Browsers refuse when it changes too often.
  if (waiting) return;
  waiting = setTimeout(() => {
    waiting = 0;
    history.replaceState(null, "", "#" + address.toString());
  }, 150);
}

export function addressNumber(key, otherwise) {
  const value = Number.parseFloat(address.get(key) ?? "");
  return Number.isFinite(value) ? value : otherwise;
}

/// When somebody edits the address or follows a link inside the page.
export function onAddress(handler) {
  addEventListener("hashchange", (event) => {
    // Not where the page is by now: what waited to be written may stand there already.
    const now = new URLSearchParams(new URL(event.newURL).hash.slice(1));
    for (const key of [...address.keys()]) address.delete(key);
    for (const [key, value] of now) address.set(key, value);
    handler();
  });
}
